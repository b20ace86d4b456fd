// The sea's surface as it is simulated: at every picture each point of the mesh is raised to the sum of the same waves
// that move the vehicle, at the time that the clock shows. Python draws the mesh, fine near the vehicle, and gives the
// waves with it (dq_marine/viewer/world/sea.py):
//
//     height = sum over j of a_j cos(omega_j t + phi_j - k_j . (north, east)),
//
// of which a point leaves out the waves that are too short for the mesh around it. Slopes make it lighter and darker.
"use strict";

const sea = (() => {
  const RESOLVED = 1.6;  // radians of a wave from one point to the next, at most
  const LIGHT = [-0.5, -0.6];  // where slopes are lighter: towards the sun, north and east
  const CONTRAST = 0.55;
  const part = (...path) => viewer.scene_tree.find(["world", ...path]).object;

  // The mesh is a grid, so that exp(i theta) is a product of one number for each wave and column, one for each wave and
  // row, and one for each wave: no sine is taken point by point.
  let mesh = null, waves = [], ticks = [], counts = null, turns = null;

  function take(drawn) {
    mesh = drawn;
    // Longest waves first, so that a point takes as many as its mesh resolves.
    waves = drawn.userData.waves.map(([a, omega, north, east, phase]) => ({a, omega, north, east, phase}))
      .sort((one, other) => Math.hypot(one.north, one.east) - Math.hypot(other.north, other.east));
    const places = drawn.geometry.attributes.position, side = Math.round(Math.sqrt(places.count));
    ticks = Array.from({length: side}, (_, i) => places.getX(i));
    counts = ticks.map((tick, i) => {
      const apart = Math.max(ticks[Math.min(i + 1, side - 1)] - tick, tick - ticks[Math.max(i - 1, 0)]);
      return waves.filter((wave) => Math.hypot(wave.north, wave.east) * apart < RESOLVED).length;
    });
    turns = {north: turned((wave) => wave.north), east: turned((wave) => wave.east)};
  }

  function turned(number_of) {  // cosine and sine of -k x at each tick for each wave
    const values = ticks.map((tick) => waves.map((wave) => -number_of(wave) * tick));
    return {cos: Float64Array.from(values.flat(), Math.cos), sin: Float64Array.from(values.flat(), Math.sin)};
  }

  function raise() {
    const node = part("surface"), drawn = node.children[0];
    if (!drawn || !drawn.userData.waves || node.scale.x === 0) { return; }
    if (drawn !== mesh) { take(drawn); }
    const {position, color} = drawn.geometry.attributes, time = part("clock").position.x, n = waves.length;
    const tint = drawn.userData.tint, side = ticks.length, {north, east} = turns;
    const here = waves.map((wave) => (
      wave.omega * time + wave.phase - wave.north * node.position.x - wave.east * node.position.y
    ));
    const light = Float64Array.from(waves, (wave) => LIGHT[0] * wave.north + LIGHT[1] * wave.east);
    const re = new Float64Array(n), im = new Float64Array(n);
    const now = {cos: here.map((phase, j) => waves[j].a * Math.cos(phase)), sin: here.map((phase, j) => waves[j].a * Math.sin(phase))};
    for (let row = 0, i = 0; row < side; row++) {
      for (let j = 0, at = row * n; j < n; j++, at++) {
        re[j] = now.cos[j] * east.cos[at] - now.sin[j] * east.sin[at];
        im[j] = now.cos[j] * east.sin[at] + now.sin[j] * east.cos[at];
      }
      for (let column = 0; column < side; column++, i++) {
        const count = Math.min(counts[row], counts[column]);
        let height = 0, slope = 0;
        for (let j = 0, at = column * n; j < count; j++, at++) {
          height += re[j] * north.cos[at] - im[j] * north.sin[at];
          slope += (re[j] * north.sin[at] + im[j] * north.cos[at]) * light[j];
        }
        position.array[3 * i + 2] = -height;  // down
        const bright = 1 + CONTRAST * slope / (0.1 + Math.abs(slope));
        for (let c = 0; c < 3; c++) { color.array[3 * i + c] = tint[c] * bright; }
      }
    }
    position.needsUpdate = color.needsUpdate = true;
  }

  function place_among(tick) {  // the point of the mesh before it, and the share of the way to the next one
    let low = 0, high = ticks.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (ticks[middle] <= tick) { low = middle; } else { high = middle; }
    }
    return [low, (tick - ticks[low]) / (ticks[high] - ticks[low])];
  }

  function height_at(north, east) {  // of the surface as it is drawn
    const node = part("surface");
    if (!mesh || node.children[0] !== mesh) { return 0; }
    const [column, x] = place_among(north - node.position.x), [row, y] = place_among(east - node.position.y);
    if (x < 0 || x > 1 || y < 0 || y > 1) { return 0; }
    const down = mesh.geometry.attributes.position, first = row * ticks.length + column, next = first + ticks.length;
    const near = (1 - x) * down.getZ(first) + x * down.getZ(first + 1);
    const far = (1 - x) * down.getZ(next) + x * down.getZ(next + 1);
    return -((1 - y) * near + y * far);
  }

  const before_picture = [];  // what has to be done once the surface is raised
  const render = viewer.render.bind(viewer);
  viewer.render = () => {
    raise();
    for (const act of before_picture) { act(); }
    render();
  };
  return {height_at, before_picture};
})();
