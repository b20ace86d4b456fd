// What a person sees of the scene: where the camera is, and which things are shown. It acts in the page alone: the
// simulation knows nothing of it. Three.js has x north, y up and z east here.
"use strict";

(() => {
  const CAMERAS = {
    follow: "follows at a distance",
    chase: "behind the vehicle",
    onboard: "on the bow",
    top: "from above",
    side: "from starboard",
    free: "stays where it is",
  };
  const SHOWN = {
    "forces": ["/world/thrust"],
    "current": ["/world/current"],
    "trail": ["/world/trail"],
    "beams": ["/world/beams"],
    "goal": ["/world/goal"],
    "sea floor and grid": ["/world/floor"],
    "surface": ["/world/surface"],
  };
  const {make, row} = panel;
  const section = document.getElementById("panel-view");
  const thing = (path) => viewer.scene_tree.find(path.slice(1).split("/")).object;

  // Where the camera is

  let mode = "follow", anchored = null;
  const list = make("select", {id: "view-camera", title: "camera"});
  list.append(...Object.entries(CAMERAS).map(([name, place]) => make("option", {value: name, textContent: `${name}: ${place}`})));
  const choose = (name) => {
    mode = list.value = name;
    anchored = null;
    viewer.camera.up.set(0, 1, 0);
    if (name === "follow") {
      viewer.controls.target.set(0, 0, 0);
      viewer.camera.position.copy(first_position || viewer.camera.position);
    }
    viewer.set_dirty();
  };
  let first_position = null;
  list.onchange = () => { choose(list.value); list.blur(); };
  panel.bind("KeyC", "next camera", () => {
    const names = Object.keys(CAMERAS);
    choose(names[(names.indexOf(mode) + 1) % names.length]);
  });

  function axis(matrix, column) {  // a column of a three.js matrix, which has them one after the other
    return viewer.camera.position.clone().fromArray(matrix.elements, 4 * column);
  }

  function level(direction) {
    const flat = direction.clone().setY(0);
    return flat.lengthSq() > 1e-6 ? flat.normalize() : direction.clone();
  }

  function place_camera() {
    const vehicle = thing("/world/vehicle");
    vehicle.updateWorldMatrix(true, false);
    const matrix = vehicle.matrixWorld, place = axis(matrix, 3), ahead = axis(matrix, 0);
    const starboard = axis(matrix, 1), down = axis(matrix, 2), length = vehicle_length();
    const up = viewer.camera.position.clone().set(0, 1, 0);
    const from = (origin, direction, distance) => origin.clone().addScaledVector(direction, distance * length);
    const views = {
      chase: () => [from(from(place, level(ahead), -3.2), up, 1.2), from(place, level(ahead), 1), up],
      onboard: () => [from(from(place, ahead, 0.62), down, -0.12), from(place, ahead, 4), down.clone().negate()],
      top: () => [from(place, up, 5), place, axis(thing("/world").matrixWorld, 0)],
      side: () => [from(from(place, level(starboard), 3.2), up, 0.4), place, up],
    };
    const [position, target, top] = views[mode]();
    const parent = viewer.camera.parent;
    parent.updateWorldMatrix(true, false);
    viewer.camera.position.copy(parent.worldToLocal(position));
    viewer.controls.target.copy(parent.worldToLocal(target));
    viewer.camera.up.copy(top);
    viewer.camera.lookAt(target);
    viewer.set_dirty();
  }

  function stay_put() {  // the world is drawn along with the vehicle; a free camera goes along with the world
    const origin = thing("/world").position.clone();
    if (anchored) {
      // The world is moved in meshcat's frame, north, west, up; the camera's axes are north, up, east.
      const moved = origin.clone().sub(anchored), shift = moved.clone().set(moved.x, moved.z, -moved.y);
      if (shift.lengthSq() > 0) {
        viewer.camera.position.add(shift);
        viewer.controls.target.add(shift);
        viewer.set_dirty();
      }
    }
    anchored = origin;
  }

  let measured = {parts: 0, length: 0};  // anew when parts come, which they do one by one
  function vehicle_length() {
    const vehicle = thing("/world/vehicle");
    let parts = 0, least = Infinity, most = -Infinity;
    vehicle.traverse(() => { parts++; });
    if (parts !== measured.parts) {
      vehicle.traverse((part) => {
        const places = part.geometry && part.geometry.attributes.position;
        for (let i = 0; places && i < places.count; i++) {
          least = Math.min(least, places.getX(i));
          most = Math.max(most, places.getX(i));
        }
      });
      measured = {parts, length: most > least ? most - least : 0};
    }
    return measured.length || 1;
  }

  let world = null;
  function meet_the_world() {  // with another vehicle, the world is drawn anew
    const now = viewer.scene_tree.find(["world"]).object;
    if (now === world) { return; }
    world = now;
    measured = {parts: 0, length: 0};
    first_position = anchored = null;
    for (const box of boxes) { box.onchange(); }
  }

  function each_frame() {
    meet_the_world();
    if (!first_position && thing("/world/vehicle").children.length) { first_position = viewer.camera.position.clone(); }
    if (mode === "free") { stay_put(); } else if (mode !== "follow") { place_camera(); }
    requestAnimationFrame(each_frame);
  }

  // Which things are shown

  const boxes = [];
  const switches = Object.entries(SHOWN).map(([label, paths]) => {
    const box = make("input", {type: "checkbox", checked: true, id: `view-${label.replaceAll(" ", "-")}`});
    boxes.push(box);
    box.onchange = () => {
      for (const path of paths) { thing(path).visible = box.checked; }
      viewer.set_dirty();
    };
    return row(label, box);
  });

  panel.bind("KeyB", "beams of range sensors", () => document.getElementById("view-beams").click());
  section.append(row("camera", list), ...switches);
  panel.fill_help();
  each_frame();
})();
