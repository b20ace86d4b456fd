// Things that can be pulled: with Ctrl or Alt held down, or where the panel says that plain dragging pulls, the pointer
// takes the point of the thing that is under it. A line goes from that point to the hand, which is in the plane through
// the point that faces the camera. The page says where both are; what force that means is the simulation's affair.
"use strict";

(() => {
  const SVG = "http://www.w3.org/2000/svg";
  const {pane, find, pixels_of, ray_in} = pointing;
  let held = null;  // {pull, point, pointer, x, y, said}: the point in the thing's coordinates, the pointer in pixels

  // Which point is under the pointer

  function crossing({origin, direction}, a, b, c) {  // of a ray and a triangle, in lengths of the ray (Moeller, Trumbore)
    const one = b.clone().sub(a), other = c.clone().sub(a), normal = direction.clone().cross(other);
    const size = one.dot(normal), from = origin.clone().sub(a), turned = from.clone().cross(one);
    const u = from.dot(normal) / size, v = direction.dot(turned) / size, way = other.dot(turned) / size;
    return u >= 0 && v >= 0 && u + v <= 1 && way > 0 ? way : Infinity;  // never for a ray along the triangle
  }

  function nearest(part, x, y) {  // way to the first triangle of a part's mesh
    const {index, attributes: {position}} = part.geometry, ray = ray_in(part, x, y);
    const corner = (i) => ray.origin.clone().fromBufferAttribute(position, index ? index.getX(i) : i);
    let way = Infinity;
    for (let i = 0; i + 2 < (index || position).count; i += 3) {
      way = Math.min(way, crossing(ray, corner(i), corner(i + 1), corner(i + 2)));
    }
    return way;
  }

  function surface_point(thing, x, y) {  // in the thing's coordinates; null beside it
    let way = Infinity;
    thing.traverseVisible((part) => { if (part.isMesh) { way = Math.min(way, nearest(part, x, y)); } });
    if (way === Infinity) { return null; }
    const {origin, direction} = ray_in(thing, x, y);
    return origin.addScaledVector(direction, way);
  }

  // Where the hand is

  function hand_of({pull, point, x, y}) {  // in NED
    const {left, top, width, height} = pane.getBoundingClientRect(), thing = find(pull.thing), world = find("/world");
    const {origin, direction} = ray_in(world, x, y), {direction: ahead} = ray_in(world, left + width / 2, top + height / 2);
    thing.updateWorldMatrix(true, false);
    const grip = world.worldToLocal(thing.localToWorld(point.clone()));
    return origin.addScaledVector(direction, grip.sub(origin).dot(ahead) / direction.dot(ahead));
  }

  // The line

  const layer = document.createElementNS(SVG, "svg"), line = document.createElementNS(SVG, "line");
  layer.id = "pull-line";
  layer.append(line);
  document.body.append(layer);

  function draw_line() {
    const grip = held && pixels_of(find(held.pull.thing).localToWorld(held.point.clone()));
    layer.style.display = grip ? "block" : "none";
    if (!grip) { return; }
    for (const [name, value] of Object.entries({x1: grip[0], y1: grip[1], x2: held.x, y2: held.y})) {
      line.setAttribute(name, value);
    }
  }

  // Taking hold, pulling, letting go

  function let_go() {
    if (held) { held.pull.say(null); }
    held = null;
    draw_line();
  }

  function take(event) {
    const pull = panel.holds.find((one) => event.ctrlKey || event.altKey || one.alone());
    if (!pull || held || event.button || !pane.contains(event.target)) { return; }
    const point = surface_point(find(pull.thing), event.clientX, event.clientY);
    if (!point) { return; }
    held = {pull, point, pointer: event.pointerId, x: event.clientX, y: event.clientY, said: ""};
    event.preventDefault();
    event.stopImmediatePropagation();
  }

  const of_the_hand = (event) => held && event.pointerId === held.pointer;
  window.addEventListener("pointerdown", take, true);  // before meshcat's camera hears of it
  window.addEventListener("pointermove", (event) => {
    if (!of_the_hand(event)) { return; }
    [held.x, held.y] = [event.clientX, event.clientY];
    event.stopImmediatePropagation();
  }, true);
  for (const end of ["pointerup", "pointercancel"]) {
    window.addEventListener(end, (event) => { if (of_the_hand(event)) { let_go(); } }, true);
  }
  for (const end of ["blur", "pagehide"]) { window.addEventListener(end, let_go); }
  document.addEventListener("visibilitychange", () => { if (document.hidden) { let_go(); } });
  window.addEventListener("contextmenu", (event) => { if (held) { event.preventDefault(); } }, true);  // Ctrl on a Mac

  function each_frame() {  // thing and camera move while the pointer rests
    if (held && !panel.holds.includes(held.pull)) { let_go(); }  // another episode, or another vehicle
    if (held) {
      const words = [...held.point.toArray(), ...hand_of(held).toArray()];
      if (words.join() !== held.said && words.every(Number.isFinite)) {
        held.said = words.join();
        held.pull.say(words);
      }
      draw_line();
    }
    requestAnimationFrame(each_frame);
  }
  each_frame();
})();
