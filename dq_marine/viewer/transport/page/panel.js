// The panel of the live page: what a person can do, and what there is to read. Its controls are described by the
// process that draws (dq_marine/viewer/controls.py); this file shows them, and says what was done with them.
"use strict";

const panel = (() => {
  const make = (tag, properties = {}, ...children) => {
    const made = Object.assign(document.createElement(tag), properties);
    made.append(...children);
    return made;
  };
  const NARROW = 700;  // pixels: where the panel covers the scene, it waits until it is asked for
  const by_id = (id) => document.getElementById(id);

  // Words to the simulation

  let socket = null;
  const say = (name, value = null) => {
    if (socket && socket.readyState === WebSocket.OPEN) {
      socket.send(JSON.stringify({name, value}));
    }
  };

  // Keys: what each does, and how it is explained

  const actions = new Map();  // by KeyboardEvent.code: what a key does when it is pressed
  const sticks = [];          // {name, axes, pulls, sent}
  const held = new Set();     // codes of the keys that are down
  const explained = new Map();
  const KEY_NAMES = {Space: "space", Period: ".", Slash: "?", Comma: ","};
  const key_name = (code) => KEY_NAMES[code] || code.replace(/^(Key|Digit|Arrow)/, "");
  const explain = (codes, meaning) => explained.set(codes.map(key_name).join(" "), meaning);
  const types = (target) => target instanceof HTMLElement && target.matches("input[type=number], select");

  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || types(event.target)) { return; }
    const stick = sticks.some((one) => one.axes.some((axis) => [axis.plus, axis.minus].includes(event.code)));
    const act = event.key === "?" ? toggle_help : actions.get(event.code);
    if (stick) { held.add(event.code); }
    if (act && !event.repeat) { act(); }
    if (stick || act) { event.preventDefault(); }
  });
  document.addEventListener("keyup", (event) => held.delete(event.code));
  window.addEventListener("blur", () => held.clear());

  // Controls, by kind: each returns what is shown, and in `setters` how its value is shown

  const setters = new Map();
  const holds = [];   // {say, thing, alone}: holds on things, and whether plain dragging takes them
  const alone = new Set();  // names of those that it does; kept when the controls are shown anew
  const places = [];  // {name, thing, values, move}: positions, of which some can be dragged in the scene
  const row = (label, ...parts) => make("div", {className: "row"}, make("label", {textContent: label}), ...parts);
  const bind = (key, meaning, act) => {
    if (key) { actions.set(key, act); explain([key], meaning); }
  };

  const show_control = {
    button(control) {
      const press = () => say(control.name);
      bind(control.key, control.label, press);
      return make("button", {id: `control-${control.name}`, textContent: control.label, onclick: press});
    },
    switch(control) {
      const box = make("input", {type: "checkbox", id: `control-${control.name}`, checked: control.value});
      box.onchange = () => say(control.name, box.checked);
      bind(control.key, control.label, () => box.click());
      setters.set(control.name, (value) => { box.checked = value; });
      return row(control.label, box);
    },
    choice(control) {
      const list = make("select", {id: `control-${control.name}`});
      list.append(...control.options.map((option) => make("option", {value: option, textContent: option})));
      list.value = control.value;
      list.onchange = () => { say(control.name, list.value); list.blur(); };
      setters.set(control.name, (value) => { list.value = value; });
      return row(control.label, list);
    },
    slider(control) {
      const forth = control.logarithmic ? Math.log : (x) => x, back = control.logarithmic ? Math.exp : (x) => x;
      const rounded = (x) => Math.round(x / control.step) * control.step;
      const slider = make("input", {
        type: "range", id: `control-${control.name}`, min: forth(control.least), max: forth(control.most), step: "any",
      });
      const shown = make("output");
      const show = (value) => {
        const digits = Math.max(0, Math.ceil(-Math.log10(control.step)));
        shown.textContent = `${value.toFixed(digits)} ${control.unit}`;
      };
      slider.oninput = () => {
        const value = rounded(back(Number(slider.value)));
        show(value);
        say(control.name, value);
      };
      setters.set(control.name, (value) => { slider.value = forth(value); show(value); });
      setters.get(control.name)(control.value);
      return row(control.label, slider, shown);
    },
    number(control) {
      const field = make("input", {
        type: "number", id: `control-${control.name}`, min: control.least, max: control.most, value: control.value,
      });
      field.onchange = () => { say(control.name, Number(field.value)); field.blur(); };
      setters.set(control.name, (value) => { field.value = value; });
      return row(control.label, field);
    },
    place(control) {
      const values = [...control.value];
      const rows = control.axes.map((axis, i) => {
        const slider = make("input", {
          type: "range", id: `control-${control.name}-${i}`, min: control.least[i], max: control.most[i], step: "any",
        });
        const shown = make("output");
        slider.oninput = () => { place.move({[i]: Number(slider.value)}); };
        return {slider, shown, row: row(axis, slider, shown)};
      });
      const place = {
        name: control.name, thing: control.thing, values,
        show() {
          rows.forEach(({slider, shown}, i) => {
            slider.value = values[i];
            shown.textContent = `${values[i].toFixed(2)} m`;
          });
        },
        move(wanted) {  // to a coordinate for each axis, where it is told
          for (const [axis, value] of Object.entries(wanted)) {
            const rounded = Math.round(value / control.step) * control.step;
            values[axis] = Math.min(Math.max(rounded, control.least[axis]), control.most[axis]);
          }
          place.show();
          say(control.name, values);
        },
      };
      setters.set(control.name, (told) => { values.splice(0, 3, ...told); place.show(); });
      places.push(place);
      place.show();
      return make("div", {id: `control-${control.name}`}, ...rows.map((one) => one.row));
    },
    pull(control) {
      const box = make("input", {type: "checkbox", id: `control-${control.name}`, checked: alone.has(control.name)});
      box.onchange = () => { alone[box.checked ? "add" : "delete"](control.name); };
      bind(control.key, `${control.label} by dragging alone, or not`, () => box.click());
      explain(["Ctrl", "drag"], `${control.label} by the point under the pointer; Alt does the same`);
      holds.push({say: (words) => say(control.name, words), thing: control.thing, alone: () => alone.has(control.name)});
      return row(`${control.label} by dragging alone, without Ctrl`, box);
    },
    stick(control) {
      const pulls = control.axes.map(() => 0);
      const sliders = control.axes.map((axis, i) => {
        const slider = make("input", {
          type: "range", id: `control-${control.name}-${i}`, min: -1, max: 1, step: 0.01, value: 0,
        });
        slider.oninput = () => { pulls[i] = Number(slider.value); };
        slider.onchange = () => { pulls[i] = 0; };  // let go, it springs back
        explain([axis.minus, axis.plus], axis.label);
        return slider;
      });
      sticks.push({name: control.name, axes: control.axes, pulls, sliders, sent: null});
      return make("div", {id: `control-${control.name}`}, ...control.axes.map((axis, i) => row(
        axis.label, sliders[i], make("span", {className: "keys", textContent: [axis.minus, axis.plus].map(key_name).join(" ")}),
      )));
    },
  };

  const DEAD_ZONE = 0.1;  // of a gamepad's axes, which seldom rest at 0
  function pad_value(binding) {
    if (!binding.length) { return 0; }
    const pad = [...navigator.getGamepads()].find((one) => one && one.connected);
    const value = pad ? (pad.axes[binding[0]] || 0) * binding[1] : 0;
    return Math.abs(value) > DEAD_ZONE ? value : 0;
  }

  function say_sticks() {
    for (const stick of sticks) {
      const positions = stick.axes.map((axis, i) => {
        const keys = Number(held.has(axis.plus)) - Number(held.has(axis.minus));
        const sum = keys + stick.pulls[i] + pad_value(axis.pad);
        const position = Math.round(Math.max(-1, Math.min(1, sum)) * 100) / 100;
        if (document.activeElement !== stick.sliders[i] || !stick.pulls[i]) { stick.sliders[i].value = position; }
        return position;
      });
      const word = JSON.stringify(positions);
      if (word !== stick.sent) {
        stick.sent = word;
        say(stick.name, positions);
      }
    }
  }

  // What is read: numbers with their recent history

  const HISTORY = 300;
  const histories = new Map();  // by group and label: {values, output, canvas}
  const groups = new Map();

  function show_readings(content) {
    const keys = Object.entries(content.groups).flatMap(([group, rows]) => rows.map(([label]) => `${group}/${label}`));
    if ([...histories.keys()].some((key) => !keys.includes(key))) { remove_readings(); }  // of another vehicle or task
    for (const [group, rows] of Object.entries(content.groups)) {
      for (const [label, value, unit] of rows) {
        const history = history_of(group, label, unit);
        history.values.push({time: content.time, value});
        if (history.values.length > HISTORY) { history.values.shift(); }
        if (!history.hovered) { write(history, value); }
        draw(history);
      }
    }
  }

  function history_of(group, label, unit) {
    const key = `${group}/${label}`;
    if (histories.has(key)) { return histories.get(key); }
    if (!groups.has(group)) {
      const section = make("details", {open: groups.size < 2}, make("summary", {textContent: group}));
      groups.set(group, section);
      by_id("panel-readings").append(section);
    }
    const output = make("output"), canvas = make("canvas", {width: 176, height: 44});
    const history = {values: [], output, canvas, unit, hovered: false};
    canvas.onmousemove = (event) => {
      history.hovered = true;
      const share = event.offsetX / canvas.clientWidth;
      const at = history.values[Math.min(history.values.length - 1, Math.floor(share * history.values.length))];
      if (at) { write(history, at.value, at.time); }
    };
    canvas.onmouseleave = () => { history.hovered = false; write(history, history.values.at(-1).value); };
    groups.get(group).append(row(label, canvas, output));
    histories.set(key, history);
    return history;
  }

  function write(history, value, time) {
    const digits = Math.abs(value) < 10 ? 3 : 1;
    const then = time === undefined ? "" : ` at ${time.toFixed(1)} s`;
    history.output.textContent = `${value.toFixed(digits)} ${history.unit}${then}`;
  }

  function draw(history) {
    const pen = history.canvas.getContext("2d"), {width, height} = history.canvas;
    const numbers = history.values.map((one) => one.value);
    const low = Math.min(...numbers), high = Math.max(...numbers), span = Math.max(high - low, 1e-6);
    pen.clearRect(0, 0, width, height);
    pen.strokeStyle = "#37c5d8";
    pen.lineWidth = 2;
    pen.beginPath();
    numbers.forEach((number, i) => {
      const turned = history.unit === "deg" && Math.abs(number - numbers[i - 1]) > 180;  // an angle that went round
      pen[turned ? "moveTo" : "lineTo"](width * i / Math.max(numbers.length - 1, 1), 2 + (height - 4) * (1 - (number - low) / span));
    });
    pen.stroke();
  }

  function forget_readings() {
    for (const history of histories.values()) { history.values.length = 0; }
  }

  function remove_readings() {
    histories.clear();
    groups.clear();
    by_id("panel-readings").replaceChildren();
  }

  // The page as a whole

  function toggle_help() { by_id("panel-help").hidden = !by_id("panel-help").hidden; }

  function fill_help() {
    explain(["Slash"], "this list");
    explain(["KeyP"], "hide or show the panel");
    by_id("panel-keys").replaceChildren(...[...explained].map(([keys, meaning]) => make(
      "tr", {}, make("td", {}, ...keys.split(" ").map((key) => make("kbd", {textContent: key}))), make("td", {textContent: meaning}),
    )));
  }

  function show_controls(content) {
    sticks.length = places.length = holds.length = 0;
    setters.clear();
    const before = new Map([...by_id("panel-controls").children].map((section) => [section.firstChild.textContent, section.open]));
    const sections = content.groups.map((group) => {
      const buttons = group.controls.filter((control) => control.kind === "button");
      const others = group.controls.filter((control) => control.kind !== "button");
      return make(
        "details", {open: before.get(group.label) ?? group.opened}, make("summary", {textContent: group.label}),
        ...(group.note ? [make("p", {className: "note", textContent: group.note})] : []),
        ...(buttons.length ? [make("div", {className: "buttons"}, ...buttons.map(show_control.button))] : []),
        ...others.map((control) => show_control[control.kind](control)),
      );
    });
    by_id("panel-controls").replaceChildren(...sections);
    if (content.groups.length && innerWidth > NARROW) { show_panel(true); }
    fill_help();
  }

  function show_panel(open) {
    by_id("panel").hidden = !open;
    by_id("panel-open").hidden = open;
  }

  const topics = {
    controls: show_controls,
    readings: show_readings,
    values(content) {
      for (const [name, value] of Object.entries(content.values)) {
        if (setters.has(name)) { setters.get(name)(value); }
      }
    },
    notice(content) { by_id("notice").textContent = content.text; },
    title(content) { by_id("title").textContent = content.text; document.title = `${content.text} - dq-marine`; },
    episode: forget_readings,
  };

  function connect() {
    socket = new WebSocket(new URL("panel", location.href).href.replace(/^http/, "ws"));
    socket.onmessage = (event) => {
      const content = JSON.parse(event.data);
      if (topics[content.path]) { topics[content.path](content); }
    };
  }

  document.addEventListener("keydown", (event) => {
    if (event.code === "KeyP" && !types(event.target)) { show_panel(by_id("panel").hidden); }
  });
  by_id("panel-close").onclick = () => show_panel(false);
  by_id("panel-open").onclick = () => show_panel(true);
  by_id("panel-help-open").onclick = by_id("panel-help-close").onclick = toggle_help;
  (function each_frame() { say_sticks(); requestAnimationFrame(each_frame); })();
  connect();
  const connected = () => socket.readyState === WebSocket.OPEN;
  return {bind, connected, fill_help, make, places, holds, row};
})();
