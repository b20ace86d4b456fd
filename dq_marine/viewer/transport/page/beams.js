// The beams of range sensors, laid at every picture from what they tell at the time that the clock shows
// (dq_marine/viewer/world/beams.py): brighter and brighter to a mark at the echo; where none came back, fainter and fainter
// to the reach. A distance stands until the next one. All are one object, whose arrays are written anew, not made anew.
"use strict";

const beams = (() => {
  const BEGUN = 0.3, ECHO = 1, MISSED = 0.3;  // opacities: of a beam that hits, at its ends; and of one that misses
  const CORNERS = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]];
  const EDGES = CORNERS.flatMap((one, i) => CORNERS.slice(i + 1).filter((_, j) => j !== 2).flatMap((other) => [one, other]));
  const VERTICES = 2 + EDGES.length;  // of a beam and its mark, an octahedron
  const part = (...path) => viewer.scene_tree.find(["world", ...path]).object;
  const drawn = () => part("beams").children.find((child) => child.isLineSegments);
  let laid = {};

  function room_for(lines, count) {
    if (lines.geometry === laid.geometry && lines.geometry.attributes.position.count === count) { return; }
    const geometry = lines.geometry, {constructor: Attribute} = geometry.attributes.position;
    geometry.dispose();
    geometry.setAttribute("position", new Attribute(new Float32Array(3 * count), 3));
    geometry.setAttribute("color", new Attribute(new Float32Array(4 * count), 4));
    lines.frustumCulled = false;
  }

  function row_at(times, now) {  // the last that has come; the clock has single precision, hence the millisecond
    let low = 0, high = times.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (times[middle] <= now + 0.001) { low = middle; } else { high = middle - 1; }
    }
    return low;
  }

  function lay() {
    const lines = drawn();
    if (!lines) { return; }
    const data = lines.userData, row = row_at(data.times, part("clock").position.x);
    if (data === laid.data && row === laid.row) { return; }
    room_for(lines, data.count * VERTICES);
    laid = {data, row, geometry: lines.geometry};
    const {position, color} = lines.geometry.attributes, many = data.mounts.length > 7 * data.count;
    for (let beam = 0, at = 0; beam < data.count; beam++) {
      const mount = 7 * ((many ? row * data.count : 0) + beam), reach = data.mounts[mount + 6];
      const distance = data.distances[row * data.count + beam], met = distance < reach;
      const place = (along) => [0, 1, 2].map((i) => data.mounts[mount + i] + along * data.mounts[mount + 3 + i]);
      const put = ([x, y, z], opacity) => { position.setXYZ(at, x, y, z); color.setXYZW(at++, ...data.color, opacity); };
      const end = place(distance);
      put(place(0), met ? BEGUN : MISSED);
      put(end, met ? ECHO : 0);
      for (const corner of EDGES) { put(end.map((middle, i) => middle + (met ? data.mark * corner[i] : 0)), met ? ECHO : 0); }
    }
    position.needsUpdate = color.needsUpdate = true;
  }

  sea.before_picture.push(lay);
  return {present: () => Boolean(drawn()) && part("beams").scale.x > 1e-3};
})();
