// A thing that cannot be seen now is drawn very small (HIDDEN_SCALE, dq_marine/viewer/placement.py). Here it is not
// drawn at all: on a processor without a graphics card each of its triangles costs time. What is left out is the
// thing itself; its node stays visible, because a person may switch that off and on.
"use strict";

(() => {
  const HIDDEN = 1e-5;  // scales below it
  const node_class = Object.getPrototypeOf(viewer.scene_tree);
  const set_transform = node_class.set_transform;
  node_class.set_transform = function (matrix) {
    set_transform.call(this, matrix);
    const thing = this.children["<object>"];
    if (thing) { thing.object.visible = this.object.scale.x > HIDDEN; }
  };
})();
