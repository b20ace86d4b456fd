// Things that can be dragged: a place of the panel whose thing is under the pointer goes along with it, in the level
// plane that it is in; with Shift up and down. The camera keeps still meanwhile.
"use strict";

(() => {
  const NEAR = 24;  // pixels from the middle of a thing within which the pointer takes it
  const {pane, find, pixels_of, ray_in} = pointing;
  let dragged = null;

  function middle_of(place) {  // in pixels, or null where it is not seen
    const thing = find(place.thing);
    if (!thing.children.length || thing.scale.x === 0) { return null; }
    return pixels_of(thing.getWorldPosition(viewer.camera.position.clone()));
  }

  function under(event) {
    return panel.places.find((place) => {
      const middle = place.thing && middle_of(place);
      return middle && Math.hypot(middle[0] - event.clientX, middle[1] - event.clientY) < NEAR;
    });
  }

  function drag(place, event) {
    const {origin, direction} = ray_in(find("/world"), event.clientX, event.clientY);  // in NED
    const [north, east, down] = place.values;
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
