// What the colours and arrows of the scene mean: how many newtons, or metres per second, an arrow has that is as long as
// the one in the legend, seen where the vehicle is; and where wind, waves and current come from and go to. The numbers
// are in the scene itself (dq_marine/viewer/world/dials.py), so that they are right in replays, too.
"use strict";

(() => {
  const RED = "#ff4a3a", WHITE = "#e8fbff", YELLOW = "#ffe66d", GREEN = "#5cffa0", VIOLET = "#c24bff";
  const PEACH = "#ffc98a", CYAN = "#4fd1ff", PINK = "#ff4fc8";
  const LONGEST = 90, OFTEN = 100;  // pixels of a scale's arrow; milliseconds from one look at the scene to the next
  const UNITS = [[1e6, "MN"], [1e3, "kN"], [1, "N"]];
  const SMALL = 1e-3;  // what is drawn smaller is hidden
  const dial = (name) => node("world", "dials", name).position;
  const make = (tag, properties = {}, ...children) => {
    const made = Object.assign(document.createElement(tag), properties);
    made.append(...children);
    return made;
  };

  // Rows: an arrow to measure by, or a spot of colour, and words

  function arrow_row(id, color) {
    const arrow = make("span", {className: "arrow"}), words = make("span");
    arrow.style.background = arrow.style.borderColor = color;
    const row = make("div", {className: "row", id}, arrow, words);
    return {row, arrow, words};
  }

  function spot(color, name) {
    const mark = make("span", {className: "spot"});
    mark.style.background = color;
    return [mark, make("span", {textContent: name})];
  }

  function spot_row(id, color) {
    const [mark, words] = spot(color, "");
    return {row: make("div", {className: "row", id}, mark, words), words};
  }

  const thrust = arrow_row("legend-thrust", RED), current = arrow_row("legend-current", WHITE);
  const wind = spot_row("legend-wind", PEACH), waves = spot_row("legend-waves", CYAN);
  const goal = spot(GREEN, "goal"), echo = spot(PINK, "echo of a beam");
  const track = typeof overlay === "object" ? [] : spot(YELLOW, "track");  // flights that are overlaid have a colour each
  const spots = make("div", {className: "row spots"}, ...spot(VIOLET, "bow"), ...track, ...goal, ...echo);
  element("legend-rows").append(thrust.row, current.row, wind.row, waves.row, spots);

  // Numbers

  function rounded_down(most) {  // the largest of 1, 2, 5 times a power of ten
    const decade = 10 ** Math.floor(Math.log10(most));
    return [5, 2, 1].find((step) => step * decade <= most) * decade;
  }

  const plain = (value) => String(Number(value.toPrecision(3)));
  const newtons = (value) => {
    const [size, unit] = UNITS.find(([least]) => Number(plain(value)) >= least) || UNITS.at(-1);
    return `${plain(value / size)} ${unit}`;
  };
  const bearing = (north, east) => {  // degrees from north, clockwise
    const whole = Math.round(Math.atan2(east, north) * 180 / Math.PI);
    return `${String((whole + 360) % 360).padStart(3, "0")}°`;
  };
  const write = (words, text) => { if (words.textContent !== text) { words.textContent = text; } };

  function pixels_per_metre() {  // of what is as far from the camera as the vehicle
    const {camera} = viewer, place = camera.position.clone(), vehicle = camera.position.clone();
    camera.getWorldPosition(place);
    node("world", "vehicle").getWorldPosition(vehicle);
    const half_height = Math.tan(camera.fov * Math.PI / 360) * place.distanceTo(vehicle) / camera.zoom;
    return viewer.renderer.domElement.clientHeight / (2 * half_height);
  }

  function scale(one, path, pixels, unit, words) {
    const drawn = node(...path, "<object>").userData;
    one.row.hidden = !words || !drawn.per_metre || !node(...path.slice(0, 2)).visible;
    if (one.row.hidden) { return; }
    const value = rounded_down(LONGEST / pixels * drawn.per_metre);
    one.arrow.style.width = `${value / drawn.per_metre * pixels}px`;
    write(one.words, `= ${unit(value)} ${words}`);
  }

  // The rose: up is where the camera looks, so that its arrows lie as those of the scene do

  function looking() {  // radians from north, clockwise
    const {camera} = viewer, ahead = camera.position.clone();
    camera.getWorldDirection(ahead);
    if (Math.hypot(ahead.x, ahead.z) < 0.1) { ahead.setFromMatrixColumn(camera.matrixWorld, 1); }
    return Math.atan2(ahead.z, ahead.x);
  }

  function draw_rose(arrows) {
    const canvas = element("legend-rose"), pen = canvas.getContext("2d"), middle = canvas.width / 2, radius = 0.76 * middle;
    const turned = looking();
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, canvas.width, canvas.height);
    pen.translate(middle, middle);
    pen.lineWidth = 2;
    pen.strokeStyle = "#7fb0c6";
    pen.beginPath();
    pen.arc(0, 0, radius, 0, 2 * Math.PI);
    pen.stroke();
    pen.fillStyle = "#f2fbff";
    pen.font = "bold 26px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillText("N", -1.17 * radius * Math.sin(turned), -1.17 * radius * Math.cos(turned));
    for (const {color, azimuth, from, to} of arrows) {
      pen.save();
      pen.rotate(azimuth - turned);
      pen.strokeStyle = pen.fillStyle = color;
      pen.lineWidth = 6;
      pen.beginPath();
      pen.moveTo(0, -from * radius);
      pen.lineTo(0, -to * radius + 12);
      pen.stroke();
      pen.beginPath();
      pen.moveTo(0, -to * radius);
      pen.lineTo(12, -to * radius + 20);
      pen.lineTo(-12, -to * radius + 20);
      pen.fill();
      pen.restore();
    }
  }

  function bow() {  // azimuth of the vehicle's x axis
    const {elements} = node("world", "vehicle").matrixWorld;
    return Math.atan2(elements[2], elements[0]);
  }

  function update() {
    const pixels = pixels_per_metre();
    const water = dial("current"), flow = water.length(), air = dial("wind"), sea = dial("waves");
    const actuators = dial("actuators").x > 0;
    const name = actuators ? "thrust of each actuator · net" : "net thrust ·", moment = newtons(dial("moment").length());
    const net = `${name} ${newtons(dial("force").length())}, ${moment} m`;
    scale(thrust, ["world", "thrust", actuators ? "0" : "net"], pixels, newtons, net);
    const stream = `current · ${flow.toFixed(2)} m/s to ${bearing(water.x, water.y)}`;
    scale(current, ["world", "current", "0"], pixels, (value) => `${plain(value)} m/s`, flow > SMALL && stream);
    const blowing = Math.hypot(air.x, air.y), height = Math.hypot(sea.x, sea.y);
    wind.row.hidden = !(blowing > SMALL);
    write(wind.words, `wind ${blowing.toFixed(1)} m/s from ${bearing(-air.x, -air.y)}`);
    waves.row.hidden = !(height > SMALL);
    write(waves.words, `waves from ${bearing(-sea.x, -sea.y)}, Hs ${plain(height)} m, Tp ${plain(sea.z)} s`);
    const aims = ["ghost", "ball"].some((kind) => node("world", "goal", kind).scale.x > SMALL);
    for (const part of goal) { part.hidden = !aims; }
    for (const part of echo) { part.hidden = !beams.present() || !node("world", "beams").visible; }
    const coming = (color, there) => ({color, azimuth: Math.atan2(there.y, there.x), from: -1, to: -0.3});
    const arrows = [
      ...(height > SMALL ? [coming(CYAN, sea)] : []),
      ...(blowing > SMALL ? [coming(PEACH, air)] : []),
      ...(flow > SMALL ? [{color: WHITE, azimuth: Math.atan2(water.y, water.x), from: -0.25, to: 0.5}] : []),
    ];
    element("legend-rose").hidden = arrows.length === 0;
    if (arrows.length) { draw_rose([...arrows, {color: VIOLET, azimuth: bow(), from: 0.85, to: 1.05}]); }
  }

  let looked = -Infinity;
  function each_frame() {
    const now = performance.now();
    if (now - looked > OFTEN && node("world", "floor", "sand", "<object>").userData.cell) {  // once there is a scene
      looked = now;
      update();
    }
    requestAnimationFrame(each_frame);
  }
  each_frame();
})();
