// Above the surface there is sky, below it murk: what is around, how the surface looks and whether specks hang in the water
// follow the camera through the surface. Python gives both sides with the surface (dq_marine/viewer/world/water.py).
"use strict";

(() => {
  const part = (...path) => viewer.scene_tree.find(["world", ...path]).object;
  let side = null, dressed = null;

  function camera_depth() {  // below the surface as it is drawn where the camera is [m]
    const world = part();
    for (const node of [world, viewer.camera]) { node.updateWorldMatrix(true, false); }
    const place = world.worldToLocal(viewer.camera.getWorldPosition(viewer.camera.position.clone()));
    return place.z + sea.height_at(place.x, place.y);
  }

  function dress() {
    const drawn = part("surface").children[0];
    if (!drawn || !drawn.userData.sides) { return; }
    const now = camera_depth() > 0 ? "below" : "above";
    if (now === side && drawn === dressed) { return; }
    [side, dressed] = [now, drawn];
    const {top, bottom, murk, tint, opacity, order} = drawn.userData.sides[side];
    viewer.set_property(["Background"], "top_color", top);
    viewer.set_property(["Background"], "bottom_color", bottom);
    viewer.scene.fog.color = murk;
    drawn.material.color.setRGB(...tint.map((share, c) => share / drawn.userData.tint[c]));
    drawn.material.opacity = opacity;
    drawn.renderOrder = order;
    part("specks").visible = side === "below";
  }

  sea.before_picture.push(dress);
})();
