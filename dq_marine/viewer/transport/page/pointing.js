// Where the pointer points: rays through it, and where things are on the screen. For the files that take hold of things.
"use strict";

const pointing = (() => {
  const pane = document.getElementById("meshcat-pane");
  const find = (path) => viewer.scene_tree.find(path.slice(1).split("/")).object;

  function pixels_of(place) {  // of a place in three.js' world; null where it is not seen
    const {left, top, width, height} = pane.getBoundingClientRect(), at = place.clone().project(viewer.camera);
    return Math.abs(at.z) > 1 ? null : [left + width * (1 + at.x) / 2, top + height * (1 - at.y) / 2];
  }

  function ray_in(object, x, y) {  // from the camera through a pixel: origin and direction in an object's coordinates
    const {left, top, width, height} = pane.getBoundingClientRect();
    const origin = viewer.camera.getWorldPosition(viewer.camera.position.clone());
    const through = origin.clone().set(2 * (x - left) / width - 1, 1 - 2 * (y - top) / height, 0.5).unproject(viewer.camera);
    object.updateWorldMatrix(true, false);
    object.worldToLocal(origin);
    return {origin, direction: object.worldToLocal(through).sub(origin)};
  }

  return {pane, find, pixels_of, ray_in};
})();
