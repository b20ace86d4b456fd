// The page whose picture is taken. A picture has the size that was asked for, whatever the browser's window looks
// like, and the scene is drawn only when a picture is taken: no animation loop. Nobody looks at the page, so the
// browser is not to draw it, too.
"use strict";

const pane = document.getElementById("meshcat-pane");
const viewer = new MeshCat.Viewer(pane, false);

(() => {
  const asked = new URLSearchParams(location.search);
  const set_size = viewer.set_3d_pane_size.bind(viewer);
  viewer.set_3d_pane_size = () => set_size(Number(asked.get("width")), Number(asked.get("height")));
  viewer.set_3d_pane_size();
  pane.style.display = "none";

  // A picture goes out as it is in memory, which takes a fraction of the time that packing it as PNG does: "RGBA",
  // width and height as 32-bit numbers, and the pixels row by row from the bottom (dq_marine/viewer/transport/picture.py).
  function picture() {
    viewer.render();
    const gl = viewer.renderer.getContext(), width = gl.drawingBufferWidth, height = gl.drawingBufferHeight;
    const message = new Uint8Array(12 + 4 * width * height), head = new DataView(message.buffer);
    message.set([..."RGBA"].map((letter) => letter.charCodeAt(0)));
    head.setUint32(4, width, true);
    head.setUint32(8, height, true);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, message.subarray(12));
    return message;
  }

  const handle = viewer.handle_command.bind(viewer);
  viewer.handle_command = (command) => {
    if (command.type === "capture_image") { viewer.connection.send(picture()); } else { handle(command); }
  };
  viewer.connect(new URL("socket", location.href).href.replace(/^http/, "ws"));
  // The last page closes the browser: it ends with the server even if nobody is left to end it.
  viewer.connection.addEventListener("close", () => window.close());
})();
