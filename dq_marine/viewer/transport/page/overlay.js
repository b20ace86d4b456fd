// Several flights in one scene (dq_marine/viewer/overlay.py): a legend of their names and colours that shows and hides each
// and says which one the camera follows, and plots of them, whose cursor is at the time that the clock shows. A press on a
// plot goes to that time.
"use strict";

(() => {
  const {begin, end, flights, charts} = overlay;
  const HEIGHT = 70, MARGIN = 4;  // of a plot, in pixels
  const ROUNDING = 0.001;  // seconds: the clock has single precision
  const make = (tag, properties = {}, ...children) => {
    const made = Object.assign(document.createElement(tag), properties);
    made.append(...children);
    return made;
  };
  const at = (path) => node(...path.slice(1).split("/"));
  const shown = flights.map(() => true);
  let followed = 0;

  // The legend

  const ends = flights.map(({name, color, caption, paths}, index) => {
    const box = make("input", {type: "checkbox", checked: true}), spot = make("span", {className: "spot"});
    const eye = make("input", {type: "radio", name: "followed", checked: index === 0, title: "the camera follows it"});
    const ended = make("span", {className: "ended"});
    spot.style.background = box.style.accentColor = color;
    box.onchange = () => {
      shown[index] = box.checked;
      for (const path of paths) { at(path).visible = box.checked; }
      viewer.set_dirty();
      plots.forEach((plot) => plot.draw());
    };
    eye.onchange = () => { followed = index; };
    const row = make("label", {}, box, spot, make("span", {textContent: name}), ended);
    element("overlay-flights").append(make("div", {className: "row"}, row, eye));
    if (caption) { element("overlay-flights").append(make("div", {className: "caption", textContent: caption})); }
    return ended;
  });

  element("overlay").addEventListener("keydown", (event) => event.stopPropagation());  // its boxes have the space key

  // The camera: the world is drawn along with the first vehicle; with another, the camera goes along besides

  const away = viewer.camera.position.clone().set(0, 0, 0);  // how far it has gone already, in three.js' world

  function follow() {
    const place = (index) => at(flights[index].vehicle).getWorldPosition(away.clone());
    const wanted = place(followed).sub(place(0)), moved = wanted.clone().sub(away);
    if (moved.lengthSq() === 0) { return; }
    const {parent} = viewer.camera, shift = parent.worldToLocal(moved).sub(parent.worldToLocal(away.clone().set(0, 0, 0)));
    viewer.camera.position.add(shift);
    viewer.controls.target.add(shift);
    away.copy(wanted);
    viewer.set_dirty();
  }

  // The plots

  const share_of = (time) => end > begin ? (time - begin) / (end - begin) : 0;
  function written(value) {
    const short = Number(value.toPrecision(3));
    return Math.abs(short) < 1e6 ? String(short) : short.toExponential();
  }

  function make_plot({label, low, high, logarithmic}) {
    const canvas = make("canvas"), cursor = make("div", {className: "cursor"}), pen = canvas.getContext("2d");
    const range = `${written(low)} to ${written(high)}${logarithmic ? ", log" : ""}`;
    const header = make("header", {}, make("span", {textContent: label}), make("span", {className: "range", textContent: range}));
    element("overlay-plots").append(make("div", {className: "plot"}, header, canvas, cursor));
    const scale = logarithmic ? Math.log : (value) => value;
    const height_of = (value) => (scale(Math.max(value, low)) - scale(low)) / (scale(high) - scale(low));
    const y_of = (value) => HEIGHT - MARGIN - (HEIGHT - 2 * MARGIN) * height_of(value);

    function draw() {
      const ratio = window.devicePixelRatio, width = canvas.clientWidth;
      [canvas.width, canvas.height] = [width * ratio, HEIGHT * ratio];
      pen.scale(ratio, ratio);
      pen.lineWidth = 1.5;
      flights.forEach(({color, times, plots: {[label]: values}}, index) => {
        if (!values || !shown[index]) { return; }
        pen.strokeStyle = color;
        pen.beginPath();
        let drawing = false;
        values.forEach((value, i) => {
          if (value === null) { drawing = false; return; }
          const place = [share_of(times[i]) * width, y_of(value)];
          if (drawing) { pen.lineTo(...place); } else { pen.moveTo(...place); }
          drawing = true;
        });
        pen.stroke();
      });
    }

    const go = (event) => {
      const {left, width} = canvas.getBoundingClientRect();
      seek(Math.max(0, Math.min(1, (event.clientX - left) / width)) * (end - begin));
    };
    canvas.onpointerdown = (event) => { canvas.setPointerCapture(event.pointerId); go(event); };
    canvas.onpointermove = (event) => { if (event.buttons) { go(event); } };
    new ResizeObserver(draw).observe(canvas);
    return {draw, move: (share) => { cursor.style.left = `${share * canvas.clientWidth}px`; }};
  }

  const plots = charts.map(make_plot);

  function each_frame() {
    const now = node("world", "clock").position.x;
    flights.forEach(({trail, times}, index) => {
      const last = times.at(-1), over = end - last > ROUNDING && now > last - ROUNDING;
      if (index > 0) { end_at_vehicle(at(`${trail}/<object>`).geometry, times); }
      const text = over ? `ended at ${last.toFixed(1)} s` : "";
      if (ends[index].textContent !== text) { ends[index].textContent = text; }
    });
    for (const plot of plots) { plot.move(share_of(now)); }
    follow();
    requestAnimationFrame(each_frame);
  }
  each_frame();
})();
