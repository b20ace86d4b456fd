// Motion before sharpness: where a computer without a graphics card cannot draw moving things often enough, it draws
// them at a lower resolution, and again at the full one as soon as they stand still.
"use strict";

(() => {
  const SLOW = 60, FAST = 25;  // milliseconds from one picture to the next: beyond, and within which the share changes
  const SHARES = [1, 0.7, 0.5];  // of the full resolution; from one to the next a picture takes about half the time
  const STILL = 400;  // milliseconds without a picture
  const WEIGHT = 0.2;  // of the newest in the running mean
  const full = viewer.renderer.getPixelRatio();
  let level = 0, shown = 1, mean = 0, last = -Infinity;

  function start_at(wanted) {
    level = wanted;
    mean = (SLOW + FAST) / 2;
  }

  function show_at(share) {
    if (share !== shown) {
      shown = share;
      viewer.renderer.setPixelRatio(full * share);
    }
  }

  const render = viewer.render.bind(viewer);
  viewer.render = () => {
    const now = performance.now(), apart = now - last;
    last = now;
    if (apart < STILL) {
      mean += WEIGHT * (apart - mean);
      if (mean > SLOW && level < SHARES.length - 1) { start_at(level + 1); }
      if (mean < FAST && level > 0) { start_at(level - 1); }
      show_at(SHARES[level]);
    }
    render();
  };

  function each_frame() {
    if (shown !== 1 && performance.now() - last > STILL) {
      show_at(1);
      last = -Infinity;
      viewer.set_dirty();
    }
    requestAnimationFrame(each_frame);
  }
  start_at(0);
  each_frame();
})();
