// A line that is drawn anew, as the trail is at every picture, keeps its material and takes the new points; beams, which
// beams.js lays, keep their points, too, and take the new data. With the last
// material of its kind its program would go, too, and be compiled again for the next one, which takes longer than a picture.
"use strict";

(() => {
  const node_class = Object.getPrototypeOf(viewer.scene_tree);
  const set_object = node_class.set_object;
  node_class.set_object = function (drawn) {
    const old = this.object;
    if (!old.isLine || !drawn.isLine || !old.material.color.equals(drawn.material.color)) {
      set_object.call(this, drawn);
      return;
    }
    const [kept, left] = old.isLineSegments ? [old, drawn] : [drawn, old];
    left.geometry.dispose();
    old.geometry = kept.geometry;
    old.userData = drawn.userData;
    drawn.material.dispose();
  };
})();
