// The foam behind a vessel that floats. At every picture its bands (dq_marine/viewer/world/wake.py) are laid along the
// recent track, which the trail has with its times, on the surface as sea.js has raised it. Foam stays in the water, which
// a current moves; it fades with the way since the vessel was there, and a slow vessel makes none.
"use strict";

(() => {
  const REACH = 7, SPREAD = 0.16;  // lengths of the vessel that the foam can be seen; how fast its sides go apart
  const LEAST_FROUDE = 0.03, FULL_FROUDE = 0.1, GRAVITY = 9.81;
  const EDGE = 0.014, CORE = 0.24;  // half widths of a side band over the length, and of the one amidships over the width
  const LIFT = 0.002;  // above the surface, over the length
  const part = (...path) => viewer.scene_tree.find(["world", ...path]).object;

  // The track behind the vessel, nearest first: where its water is now, the way since then, and how much foam it has
  function track_behind(length) {
    const line = part("trail", "<object>"), places = line.geometry && line.geometry.attributes.position;
    const times = line.userData.times, now = part("clock").position.x, here = part("vehicle").position;
    const flow = part("dials", "current").position;
    const track = [{x: here.x, y: here.y, way: 0, foam: 0}];
    if (!places || !times) { return track; }
    let then = now;
    for (let i = Math.min(places.count, line.geometry.drawRange.count) - 1; i >= 0; i--) {
      const age = now - times[i], last = track.at(-1);
      if (!(times[i] < then)) { continue; }
      const x = places.getX(i) + age * flow.x, y = places.getY(i) + age * flow.y;
      const step = Math.hypot(x - last.x, y - last.y), froude = step / (then - times[i]) / Math.sqrt(GRAVITY * length);
      const foam = Math.max(0, Math.min(1, (froude - LEAST_FROUDE) / (FULL_FROUDE - LEAST_FROUDE)));
      track.push({x, y, way: last.way + step, foam});
      then = times[i];
      if (track.at(-1).way > REACH * length) { break; }
    }
    if (track.length > 1) { track[0].foam = track[1].foam; }
    return track;
  }

  function at_way(track, way) {  // between two points of the track; beyond its end there is no foam
    const after = track.findIndex((point) => point.way >= way);
    if (after < 0) { return {...track.at(-1), foam: 0, ahead: [0, 0]}; }
    const [near, far] = [track[Math.max(after - 1, 0)], track[Math.max(after, 1)]], span = far.way - near.way;
    const share = span > 0 ? (way - near.way) / span : 0, mix = (name) => near[name] + share * (far[name] - near[name]);
    const ahead = span > 0 ? [(near.x - far.x) / span, (near.y - far.y) / span] : [0, 0];
    return {x: mix("x"), y: mix("y"), foam: mix("foam"), ahead};
  }

  function lay() {
    const drawn = part("wake").children[0];
    if (!drawn || !drawn.geometry) { return; }
    const {length, width, stations, foam, sea: tint} = drawn.userData, {position, color} = drawn.geometry.attributes;
    const track = track_behind(length);
    drawn.visible = track.some((point) => point.foam > 0);
    drawn.frustumCulled = false;
    if (!drawn.visible) { return; }
    for (let station = 0; station < stations; station++) {
      const share = station / (stations - 1), way = share * REACH * length, point = at_way(track, way);
      const strength = point.foam * (1 - share), side = 0.4 * width + SPREAD * way;
      [[0, CORE * width], [-side, EDGE * length], [side, EDGE * length]].forEach(([aside, half], band) => {
        [-1, 1].forEach((edge, column) => {
          const off = aside + edge * half * strength, i = 2 * (band * stations + station) + column;
          const x = point.x - point.ahead[1] * off, y = point.y + point.ahead[0] * off;
          position.setXYZ(i, x, y, -sea.height_at(x, y) - LIFT * length);
          color.setXYZ(i, ...foam.map((bright, c) => tint[c] + strength * (bright - tint[c])));
        });
      });
    }
    position.needsUpdate = color.needsUpdate = true;
  }

  sea.before_picture.push(lay);
})();
