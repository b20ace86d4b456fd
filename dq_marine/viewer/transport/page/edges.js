// Smooth edges take more than a third of a picture's time where there is no graphics card: there they are left out, unless the
// address asks for them with ?smooth=1. With a graphics card they cost nothing worth naming, and ?smooth=0 leaves them out.
"use strict";

(() => {
  const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;

  function has_graphics_card() {
    const gl = document.createElement("canvas").getContext("webgl");
    const names = gl && gl.getExtension("WEBGL_debug_renderer_info");
    const name = names ? gl.getParameter(names.UNMASKED_RENDERER_WEBGL) : "";
    if (gl) { gl.getExtension("WEBGL_lose_context")?.loseContext(); }
    return !SOFTWARE.test(name);
  }

  const asked = new URLSearchParams(location.search).get("smooth");
  const antialias = asked === null ? has_graphics_card() : asked === "1";
  const context_of = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, options) {
    return context_of.call(this, kind, kind.startsWith("webgl") ? {...options, antialias} : options);
  };
})();
