// Things that can be dragged: a place of the panel whose thing is under the pointer goes along with it, in the level
// plane that it is in; with Shift up and down. The camera keeps still meanwhile.
"use strict";

(() => {
  const NEAR = 24;  // pixels from the middle of a thing within which the pointer takes it
  const pane = document.getElementById("meshcat-pane");
  const find = (path) => viewer.scene_tree.find(path.slice(1).split("/")).object;
  let dragged = null;

  function middle_of(place) {  // in pixels, or null where it is not seen
    const thing = find(place.thing);
    if (!thing.children.length || thing.scale.x === 0) { return null; }
    const middle = thing.getWorldPosition(viewer.camera.position.clone()).project(viewer.camera);
    const {left, top, width, height} = pane.getBoundingClientRect();
    return Math.abs(middle.z) > 1 ? null : [left + width * (1 + middle.x) / 2, top + height * (1 - middle.y) / 2];
  }

  function under(event) {
    return panel.places.find((place) => {
      const middle = place.thing && middle_of(place);
      return middle && Math.hypot(middle[0] - event.clientX, middle[1] - event.clientY) < NEAR;
    });
  }

  function ray_of(event) {  // from the camera through the pointer: origin and direction in NED
    const {left, top, width, height} = pane.getBoundingClientRect();
    const world = find("/world"), origin = viewer.camera.getWorldPosition(viewer.camera.position.clone());
    const through = origin.clone().set(
      2 * (event.clientX - left) / width - 1, 1 - 2 * (event.clientY - top) / height, 0.5,
    ).unproject(viewer.camera);
    world.updateWorldMatrix(true, false);
    world.worldToLocal(origin);
    return {origin, direction: world.worldToLocal(through).sub(origin)};
  }

  function drag(place, event) {
    const {origin, direction} = ray_of(event), [north, east, down] = place.values;
    const sideways = event.shiftKey ? [origin.x - north, origin.y - east, 0] : [0, 0, 1];  // normal of the plane
    const along = (vector) => vector.x * sideways[0] + vector.y * sideways[1] + vector.z * sideways[2];
    const way = (north * sideways[0] + east * sideways[1] + down * sideways[2] - along(origin)) / along(direction);
    if (!(way > 0) || way === Infinity) { return; }  // the pointer is beyond the plane's horizon
    const at = origin.clone().addScaledVector(direction, way);
    place.move(event.shiftKey ? {2: at.z} : {0: at.x, 1: at.y});
  }

  // Before meshcat's camera hears of it
  window.addEventListener("pointerdown", (event) => {
    if (event.button || !pane.contains(event.target)) { return; }
    dragged = under(event) || null;
    if (dragged) { event.stopPropagation(); }
  }, true);
  window.addEventListener("pointermove", (event) => {
    if (dragged) { drag(dragged, event); event.stopPropagation(); }
    else if (pane.contains(event.target)) { pane.style.cursor = under(event) ? "grab" : ""; }
  }, true);
  for (const end of ["pointerup", "pointercancel", "blur"]) {
    window.addEventListener(end, () => { dragged = null; }, true);
  }
})();
