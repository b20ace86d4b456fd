// Things glide from one message to the next, at the display's own rate: messages come once in a control period.
// The clock comes first in each batch of messages; where it goes back, a new episode begins and everything jumps.
"use strict";

const glide = (() => {
  const CLOCK = "/world/clock";
  const GLIDING = ["/world", "/world/vehicle", "/world/beams", "/world/shadow", CLOCK], GLIDING_CHILDREN = "/world/thrust";
  const LONGEST = 2000, AFTER_A_PAUSE = 150;  // milliseconds from one message to the next
  const find = (path) => viewer.scene_tree.find(path.slice(1).split("/"));

  let told_at = -Infinity, last_time = Infinity, length = 0, jumping = true;
  const moving = new Map();  // by node: where it came from, and where it goes

  const glides = (node) => (
    GLIDING.some((path) => node === find(path)) || Object.values(find(GLIDING_CHILDREN).children).includes(node)
  );
  const node_class = Object.getPrototypeOf(viewer.scene_tree);
  const set_at_once = node_class.set_transform;
  node_class.set_transform = function (matrix) {
    if (this === find(CLOCK)) {
      note_the_time(matrix[12]);
    }
    const object = this.object;
    const from = {position: object.position.clone(), quaternion: object.quaternion.clone(), scale: object.scale.clone()};
    moving.delete(this);
    set_at_once.call(this, matrix);
    const shown = from.scale.x > 0 && object.scale.x > 0;
    const reversed = from.quaternion.angleTo(object.quaternion) > Math.PI / 2;  // as the arrow of a thruster may be
    if (!jumping && shown && !reversed && glides(this)) {
      const to = {position: object.position.clone(), quaternion: object.quaternion.clone(), scale: object.scale.clone()};
      moving.set(this, {from, to, began: told_at});
      place(this, 0);
    }
  };

  function note_the_time(time) {
    const now = performance.now();
    jumping = !(time > last_time) || told_at === -Infinity;
    last_time = time;
    length = now - told_at > LONGEST ? AFTER_A_PAUSE : now - told_at;
    told_at = now;
  }

  function place(node, share) {
    const {from, to} = moving.get(node), {position, quaternion, scale} = node.object;
    position.lerpVectors(from.position, to.position, share);
    quaternion.slerpQuaternions(from.quaternion, to.quaternion, share);
    scale.lerpVectors(from.scale, to.scale, share);
  }

  function each_frame() {
    const share = Math.min((performance.now() - told_at) / Math.max(length, 1), 1);
    for (const node of [...moving.keys()]) {
      place(node, share);
      viewer.set_dirty();
      if (share === 1) { moving.delete(node); }
    }
    requestAnimationFrame(each_frame);
  }
  each_frame();
  return {at_rest: () => moving.size === 0};
})();
