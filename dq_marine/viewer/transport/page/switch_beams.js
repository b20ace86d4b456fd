// In a replay: a button, and the key B, that show and hide the beams of range sensors, where there are any.
"use strict";

(() => {
  const button = element("beams"), shown = node("world", "beams");
  button.hidden = shown.children.length === 0;
  button.onclick = () => {
    shown.visible = !shown.visible;
    button.setAttribute("aria-pressed", shown.visible);
    button.blur();
    viewer.set_dirty();
  };
  document.addEventListener("keydown", (event) => {
    const plain = !event.ctrlKey && !event.metaKey && !event.altKey && !event.repeat;
    if (event.code === "KeyB" && plain && !button.hidden) { button.onclick(); }
  });
})();
