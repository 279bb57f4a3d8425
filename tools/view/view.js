// The page of flowdlo view: one frame as a picture with curves over it, and the same curves in space
// beside the measured points. Canvas alone: no WebGL, nothing from elsewhere.
"use strict";

const byId = (id) => document.getElementById(id);
const picture = byId("picture");
const space = byId("space");
const unpointed = byId("node").textContent;
const page = document.body;

const SUPPORTED = "#20b8a0";
const BRIDGED = "#e8740c";
const ROPES = ["#20b8a0", "#e8740c", "#3b6fd9", "#3fae3f", "#c04fc0", "#b8a000", "#5cc8d8", "#d95050", "#808080"];

const CURVES = [
  { key: "estimate", text: "estimate", color: SUPPORTED, on: true },
  { key: "alternatives", text: "other hypotheses", color: "#9050d0", on: true },
  { key: "prior", text: "first prior", color: "#707680", on: false },
  { key: "draws", text: "draws of the model", color: "#3b6fd9", on: false },
  { key: "path", text: "path through the mask", color: "#d9b400", on: false },
];
const CLOUDS = [
  { key: "measured", text: "on the mask", on: true },
  { key: "scenery", text: "beside it", on: true },
];
const BELOW = [
  { key: "image", text: "image" },
  { key: "field", text: "strand field" },
  { key: "mask", text: "mask" },
];

let names = [];
let frame = 0;
let asked = 0;
let scene = null;
let image = null;
let below = "image";
let pointed = -1;
const part = { times: 1, u: 0.5, v: 0.5 };  // of the picture: enlarged, and which place is in the middle
const view = { turn: 0, tilt: 0, distance: 1, at: [0, 0, 0], reach: 1 };

const on = (key) => [...CURVES, ...CLOUDS].find((one) => one.key === key).on;

// Curves of the scene as {color, width, points, dashed}, points in metres.
function lines() {
  const all = [];
  const add = (key, points, dashed) => {
    const { color } = CURVES.find((one) => one.key === key);
    if (on(key) && points.length > 1) all.push({ color, width: 1.6, points, dashed });
  };
  for (const draw of scene.draws || []) add("draws", draw.nodes, !draw.accepted);
  add("prior", scene.prior || [], false);
  for (const rope of scene.ropes) {
    for (const other of rope.alternatives) add("alternatives", other.nodes, false);
  }
  if (!on("estimate")) return all;
  scene.ropes.forEach((rope, index) => {
    const several = scene.ropes.length > 1;
    const backed = (node) => rope.support[Math.min(63, Math.max(0, node))] === 1;
    const per = (rope.curve.length - 1) / 63;
    let from = 0;
    for (let i = 1; i <= rope.curve.length - 1; i++) {
      const here = backed(Math.round(from / per));
      if (i < rope.curve.length - 1 && backed(Math.round(i / per)) === here) continue;
      const color = several ? ROPES[index % ROPES.length] : here ? SUPPORTED : BRIDGED;
      all.push({ color, width: 3.4, points: rope.curve.slice(from, i + 1), dashed: several && !here });
      from = i;
    }
    if (rope.closed) all.push({ color: SUPPORTED, width: 3.4, points: [rope.nodes[63], rope.nodes[0]], dashed: false });
  });
  return all;
}

function stroke(context, points, line) {
  context.beginPath();
  let drawing = false;
  for (const point of points) {
    if (!point) {
      drawing = false;
    } else if (drawing) {
      context.lineTo(point[0], point[1]);
    } else {
      context.moveTo(point[0], point[1]);
      drawing = true;
    }
  }
  context.setLineDash(line.dashed ? [5, 4] : []);
  context.lineJoin = context.lineCap = "round";
  context.strokeStyle = "rgba(20, 22, 26, 0.75)";
  context.lineWidth = line.width + 1.6;
  context.stroke();
  context.strokeStyle = line.color;
  context.lineWidth = line.width;
  context.stroke();
}

function marker(context, point, text, dark) {
  if (!point) return;
  context.setLineDash([]);
  context.beginPath();
  context.arc(point[0], point[1], 8.5, 0, 7);
  context.fillStyle = dark ? "#16181c" : "#ffffff";
  context.strokeStyle = dark ? "#ffffff" : "#16181c";
  context.lineWidth = 1.2;
  context.fill();
  context.stroke();
  context.fillStyle = dark ? "#ffffff" : "#16181c";
  context.font = "bold 11px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillText(text, point[0], point[1]);
}

// Curves, ends and the node pointed at, by a way from metres to the canvas; null: not to be seen.
function drawCurves(context, project) {
  for (const line of lines()) stroke(context, line.points.map(project), line);
  if (!on("estimate")) return;
  scene.ropes.forEach((rope, index) => {
    const label = scene.ropes.length > 1 ? [String(index), String(index)] : ["A", "B"];
    if (!rope.closed) {
      marker(context, project(rope.nodes[0]), label[0], false);
      marker(context, project(rope.nodes[63]), label[1], true);
    }
  });
  const node = pointed >= 0 && project(scene.ropes[pointed >> 6].nodes[pointed & 63]);
  if (!node) return;
  context.beginPath();
  context.arc(node[0], node[1], 7, 0, 7);
  context.strokeStyle = "#ff2d6f";
  context.lineWidth = 2.5;
  context.stroke();
}

// As many pixels as the screen has, and a context that counts in those of the page.
function prepared(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  canvas.width = Math.max(1, Math.round(width * ratio));
  canvas.height = Math.max(1, Math.round(height * ratio));
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return { context, width, height };
}

function placeOfPicture(width, height) {
  const zoom = part.times * Math.min(width / scene.width, height / scene.height);
  return { zoom, left: width / 2 - zoom * part.u * scene.width, top: height / 2 - zoom * part.v * scene.height };
}

// Nearer to the pixel below the mouse, which stays there.
function enlarge(event) {
  event.preventDefault();
  const box = picture.getBoundingClientRect();
  const [x, y] = [event.clientX - box.left, event.clientY - box.top];
  const before = placeOfPicture(picture.clientWidth, picture.clientHeight);
  part.times = Math.max(1, Math.min(40, part.times * Math.exp(-0.0012 * event.deltaY)));
  const after = placeOfPicture(picture.clientWidth, picture.clientHeight);
  const ratio = after.zoom / before.zoom;
  shift(x - after.left - ratio * (x - before.left), y - after.top - ratio * (y - before.top));
}

function shift(dx, dy) {
  const { zoom } = placeOfPicture(picture.clientWidth, picture.clientHeight);
  const inside = (value) => Math.max(0, Math.min(1, value));
  part.u = part.times === 1 ? 0.5 : inside(part.u - dx / zoom / scene.width);
  part.v = part.times === 1 ? 0.5 : inside(part.v - dy / zoom / scene.height);
  drawPicture();
}

function toPixel(point) {
  const [fx, fy, cx, cy] = scene.camera;
  if (!point || !(point[2] > 0)) return null;
  return [(fx * point[0]) / point[2] + cx, (fy * point[1]) / point[2] + cy];
}

function onPicture(place) {
  return (point) => {
    const pixel = toPixel(point);
    return pixel && [place.left + place.zoom * (pixel[0] + 0.5), place.top + place.zoom * (pixel[1] + 0.5)];
  };
}

function drawPicture() {
  const { context, width, height } = prepared(picture);
  if (!scene || !scene.width) return;
  const place = placeOfPicture(width, height);
  context.imageSmoothingEnabled = place.zoom < 1;
  if (image) context.drawImage(image, place.left, place.top, place.zoom * scene.width, place.zoom * scene.height);
  if (on("path") && scene.path) {
    const pixels = scene.path.map(([u, v]) => [place.left + place.zoom * (u + 0.5), place.top + place.zoom * (v + 0.5)]);
    stroke(context, pixels, { color: CURVES[4].color, width: 1.6, dashed: false });
  }
  drawCurves(context, onPicture(place));
}

// Camera frame (x right, y down, z forward) to the canvas, seen from where the mouse turned it to.
function fromSide(width, height) {
  const [ct, st, ch, sh] = [Math.cos(view.turn), Math.sin(view.turn), Math.cos(view.tilt), Math.sin(view.tilt)];
  const focal = 1.4 * Math.min(width, height);
  return (point) => {
    if (!point || point[2] === null) return null;
    const [x, y, z] = [point[0] - view.at[0], point[1] - view.at[1], point[2] - view.at[2]];
    const side = ct * x + st * z;
    const deep = -st * x + ct * z;
    const down = ch * y - sh * deep;
    const away = sh * y + ch * deep + view.distance;
    if (away < 0.02 * view.reach) return null;
    return [width / 2 + (focal * side) / away, height / 2 + (focal * down) / away, away];
  };
}

function drawCloud(context, points, project, size) {
  const seen = [];
  for (const point of points) {
    const at = project(point);
    if (at) seen.push([at, point[3]]);
  }
  seen.sort((a, b) => b[0][2] - a[0][2]);
  for (const [at, color] of seen) {
    context.fillStyle = "#" + color;
    context.fillRect(at[0] - size / 2, at[1] - size / 2, size, size);
  }
}

function drawSpace() {
  const { context, width, height } = prepared(space);
  if (!scene || !scene.width) return;
  const project = fromSide(width, height);
  context.globalAlpha = 0.35;
  if (on("scenery")) drawCloud(context, scene.scenery, project, 2);
  context.globalAlpha = 0.8;
  if (on("measured")) drawCloud(context, scene.measured, project, 2);
  context.globalAlpha = 1;
  drawCurves(context, project);
  scaleBar(context, width, height);
  page.dataset.turn = view.turn.toFixed(3);
}

// A length in metres where the rope is, so that sizes can be read off.
function scaleBar(context, width, height) {
  const metre = (1.4 * Math.min(width, height)) / view.distance;
  const length = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2].find((one) => one * metre > 60) || 2;
  context.setLineDash([]);
  context.strokeStyle = context.fillStyle = "#26292e";
  context.lineWidth = 2;
  context.beginPath();
  context.moveTo(14, height - 14);
  context.lineTo(14 + length * metre, height - 14);
  context.stroke();
  context.font = "12px system-ui, sans-serif";
  context.textAlign = "left";
  context.textBaseline = "bottom";
  context.fillText(length < 1 ? Math.round(100 * length) + " cm" : length + " m", 14, height - 18);
}

// The whole of every rope, from aslant above.
function firstView() {
  let points = scene.ropes.flatMap((rope) => rope.nodes);
  if (points.length === 0) points = scene.measured || [];
  if (points.length === 0) points = [[0, 0, 1]];
  const range = (axis) => {
    const values = points.map((point) => point[axis]).filter((value) => value !== null);
    return [Math.min(...values), Math.max(...values)];
  };
  const sides = [0, 1, 2].map(range);
  view.at = sides.map(([low, high]) => (low + high) / 2);
  view.reach = Math.max(0.02, Math.hypot(...sides.map(([low, high]) => high - low)));
  view.distance = 1.75 * view.reach;
  view.turn = 0.5;
  view.tilt = 0.35;
}

function draw() {
  drawPicture();
  drawSpace();
}

function facts() {
  const list = byId("facts");
  list.replaceChildren();
  const add = (name, value, bad) => {
    const term = document.createElement("dt");
    const said = document.createElement("dd");
    term.textContent = name;
    said.textContent = value;
    if (bad) said.className = "bad";
    list.append(term, said);
  };
  if (scene.error) add("none", scene.error, true);
  scene.ropes.forEach((rope, index) => {
    if (scene.ropes.length > 1) add("rope", String(index));
    add("what", rope.origin.replaceAll("_", " "));
    add("confidence", rope.confidence.toFixed(2), rope.confidence < 0.5);
    for (const doubt of rope.doubts) add("doubt", doubt, true);
    add("on the mask", Math.round(100 * rope.mask_agreement) + " %");
    add("supported", rope.support.filter((one) => one === 1).length + " of 64 nodes");
    add("readings", String(rope.readings));
    add("others", String(rope.alternatives.length));
    add("took", Math.round(rope.total_ms) + " ms");
  });
  if (scene.device) add("device", scene.device);
}

function tick(box, kind, one, checked, act) {
  const label = document.createElement("label");
  const input = document.createElement("input");
  input.type = kind;
  input.name = box.id;
  input.id = box.id + "-" + one.key;
  input.checked = checked;
  input.addEventListener("change", () => act(input.checked));
  label.append(input);
  if (one.color) {
    const swatch = document.createElement("i");
    swatch.style.background = one.color;
    label.append(swatch);
  }
  label.append(" " + one.text);
  box.append(label);
  return input;
}

function choices() {
  for (const one of BELOW) {
    tick(byId("below"), "radio", one, one.key === below, () => {
      below = one.key;
      remember();
      loadImage();
    });
  }
  for (const [box, list] of [[byId("curves"), CURVES], [byId("clouds"), CLOUDS]]) {
    for (const one of list) {
      tick(box, "checkbox", one, one.on, (checked) => {
        one.on = checked;
        draw();
      });
    }
  }
  const bridged = document.createElement("label");
  const swatch = document.createElement("i");
  swatch.style.background = BRIDGED;
  bridged.append(swatch, " nothing measured backs it");
  byId("curves").append(bridged);
}

function loadImage() {
  const mine = asked;
  const what = below === "field" && !scene.field ? "image" : below;
  if (!scene.width) {
    image = null;
    ready();
    return;
  }
  const loaded = new Image();
  loaded.onload = () => {
    if (mine !== asked) return;
    image = loaded;
    page.dataset.below = what;
    ready();
  };
  loaded.src = "frames/" + frame + "/" + what + ".png";
}

function ready() {
  draw();
  byId("state").textContent = scene.error ? "no estimate" : "";
  page.dataset.frame = scene.name;
  page.dataset.curves = String(lines().length);
  page.dataset.ready = "yes";
}

function remember() {
  window.history.replaceState(null, "", "#" + frame + (below === "image" ? "" : ":" + below));
}

async function show(index) {
  frame = index;
  remember();
  const mine = ++asked;
  page.dataset.ready = "no";
  byId("frame").value = String(index);
  byId("state").textContent = "estimating";
  try {
    const answer = await fetch("frames/" + index + "/scene.json");
    if (!answer.ok) throw new Error(answer.status + " " + answer.statusText);
    const next = await answer.json();
    if (mine !== asked) return;
    scene = next;
  } catch (failure) {
    if (mine === asked) byId("state").textContent = "flowdlo view does not answer: " + failure.message;
    return;
  }
  pointed = -1;
  for (const key of ["prior", "draws", "path"]) byId("curves-" + key).disabled = !scene[key];
  byId("below-field").disabled = !scene.field;
  Object.assign(part, { times: 1, u: 0.5, v: 0.5 });
  firstView();
  facts();
  loadImage();
}

function step(by) {
  show((frame + by + names.length) % names.length);
}

// The node nearest to the mouse, in the picture.
function point(event) {
  if (!scene || !scene.width) return;
  const box = picture.getBoundingClientRect();
  const project = onPicture(placeOfPicture(picture.clientWidth, picture.clientHeight));
  let best = 18;
  pointed = -1;
  scene.ropes.forEach((rope, index) => {
    rope.nodes.forEach((node, i) => {
      const at = project(node);
      if (!at) return;
      const far = Math.hypot(at[0] - (event.clientX - box.left), at[1] - (event.clientY - box.top));
      if (far < best) {
        best = far;
        pointed = 64 * index + i;
      }
    });
  });
  byId("node").textContent = pointed < 0 ? unpointed : wordsOf(pointed);
  draw();
}

function wordsOf(which) {
  const rope = scene.ropes[which >> 6];
  const i = which & 63;
  const [x, y, z] = rope.nodes[i].map((value) => value.toFixed(3));
  const backed = rope.support[i] === 1 ? "measured" : "not measured";
  return `Node ${i}: x ${x}, y ${y}, z ${z} m, sigma ${(1000 * rope.sigma_m[i]).toFixed(1)} mm, ${backed}.`;
}

function mouse() {
  let held = null;
  space.addEventListener("pointerdown", (event) => {
    held = { x: event.clientX, y: event.clientY, move: event.button === 2 || event.shiftKey };
    try {
      space.setPointerCapture(event.pointerId);
    } catch (gone) {
      // A pointer that is no longer there cannot be captured.
    }
  });
  space.addEventListener("pointermove", (event) => {
    if (!held) return;
    const [dx, dy] = [event.clientX - held.x, event.clientY - held.y];
    [held.x, held.y] = [event.clientX, event.clientY];
    if (held.move) {
      const metre = view.distance / (1.4 * Math.min(space.clientWidth, space.clientHeight));
      const [ct, st, ch, sh] = [Math.cos(view.turn), Math.sin(view.turn), Math.cos(view.tilt), Math.sin(view.tilt)];
      view.at[0] -= metre * (dx * ct + dy * sh * st);
      view.at[1] -= metre * dy * ch;
      view.at[2] -= metre * (dx * st - dy * sh * ct);
    } else {
      view.turn -= 0.008 * dx;
      view.tilt = Math.max(-1.55, Math.min(1.55, view.tilt + 0.008 * dy));
    }
    drawSpace();
  });
  const release = () => (held = null);
  space.addEventListener("pointerup", release);
  space.addEventListener("pointercancel", release);
  space.addEventListener("contextmenu", (event) => event.preventDefault());
  space.addEventListener("dblclick", () => {
    firstView();
    drawSpace();
  });
  space.addEventListener("wheel", (event) => {
    event.preventDefault();
    view.distance *= Math.exp(0.0012 * event.deltaY);
    view.distance = Math.max(0.05 * view.reach, Math.min(50 * view.reach, view.distance));
    drawSpace();
  }, { passive: false });
  picture.addEventListener("pointermove", (event) => {
    if (scene && event.buttons === 1) shift(event.movementX, event.movementY);
    point(event);
  });
  picture.addEventListener("dblclick", () => {
    Object.assign(part, { times: 1, u: 0.5, v: 0.5 });
    drawPicture();
  });
  picture.addEventListener("wheel", (event) => scene && enlarge(event), { passive: false });
}

async function begin() {
  choices();
  mouse();
  names = await (await fetch("frames.json")).json();
  byId("frame").replaceChildren(...names.map((name, i) => new Option(name, i)));
  byId("frame").addEventListener("change", () => show(Number(byId("frame").value)));
  byId("before").addEventListener("click", () => step(-1));
  byId("next").addEventListener("click", () => step(1));
  window.addEventListener("keydown", (event) => {
    if (event.target.tagName === "SELECT" || event.target.tagName === "INPUT") return;
    if (event.key === "ArrowLeft") step(-1);
    if (event.key === "ArrowRight") step(1);
  });
  new ResizeObserver(draw).observe(page);
  const [linked, layer] = window.location.hash.slice(1).split(":");  // "#3:field": of the fourth frame
  if (BELOW.some((one) => one.key === layer)) byId("below-" + (below = layer)).checked = true;
  await show(Number(linked) > 0 && Number(linked) < names.length ? Math.floor(Number(linked)) : 0);
}

begin();
