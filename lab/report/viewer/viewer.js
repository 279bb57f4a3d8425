// The 3D view of report.html: curves of one scene in a box that turns with the mouse.
// Built into viewer.min.js by `npm ci && npm run build`; the page's data come as `window.flowdlo`:
// {unit_m, colors: {method: "#rrggbb"}, order: [method], sets: [{name, scenes: [{name, text, image, curves:
// {method: [[x, y, z, x, y, z, ...], ...]}}]}]}, whole numbers of unit_m, camera frame.
import {
  AmbientLight,
  Box3,
  CatmullRomCurve3,
  Color,
  DirectionalLight,
  Group,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  Scene,
  SphereGeometry,
  TubeGeometry,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const data = window.flowdlo;
const page = document.body;
const box = document.getElementById("view");
const kFrom = new Vector3(0.25, 0.75, 0.95).normalize();  // where the first view looks from
const shown = new Set(["truth", "estimate", "trackdlo"]);
let renderer;
let camera;
let controls;
let scene;
let chosen = { set: 0, scene: 0 };

// x right, y down, z forward to x right, y up, z towards the viewer.
function points(line) {
  const result = [];
  for (let i = 0; i + 2 < line.length; i += 3) {
    result.push(
      new Vector3(line[i] * data.unit_m, -line[i + 1] * data.unit_m, -line[i + 2] * data.unit_m),
    );
  }
  return result;
}

// The truth is translucent: what is right lies inside it.
function tube(line, color, radius, solid) {
  const nodes = points(line);
  const material = new MeshLambertMaterial({
    color: new Color(color),
    transparent: !solid,
    opacity: solid ? 1 : 0.6,
    depthWrite: solid,
  });
  const group = new Group();
  group.add(new Mesh(new TubeGeometry(new CatmullRomCurve3(nodes), 252, radius, 8), material));
  const start = new Mesh(new SphereGeometry(3 * radius, 16, 12), material);
  start.position.copy(nodes[0]);
  group.add(start);
  return group;
}

function current() {
  return data.sets[chosen.set].scenes[chosen.scene];
}

function size_of(lines) {
  return new Box3().setFromPoints(lines.flatMap(points));
}

function render() {
  renderer.render(scene, camera);
  page.dataset.triangles = renderer.info.render.triangles;
  page.dataset.camera = camera.position.toArray().map((v) => v.toFixed(4)).join(" ");
}

// From where a ball of that diameter fills nine tenths of the view's shorter side.
function distance(reach) {
  const upright = Math.tan((camera.fov * Math.PI) / 360);
  return (0.5 * reach) / 0.9 / Math.sin(Math.atan(upright * Math.min(1, camera.aspect)));
}

function forget(old) {
  old.traverse((part) => {
    if (part.geometry) part.geometry.dispose();
    if (part.material) part.material.dispose();
  });
}

function draw(fit) {
  if (scene) forget(scene);
  const { curves } = current();
  const subject = curves.truth || curves.estimate || Object.values(curves)[0] || [];
  scene = new Scene();
  scene.background = new Color("#fbfbfa");
  scene.add(new AmbientLight("#ffffff", 1.6));
  const light = new DirectionalLight("#ffffff", 1.8);
  light.position.set(0.4, 1, 0.7);
  scene.add(light);
  const bounds = size_of(subject);
  const middle = bounds.getCenter(new Vector3());
  const reach = Math.max(bounds.getSize(new Vector3()).length(), 0.02);
  for (const [method, lines] of Object.entries(curves)) {
    if (!shown.has(method)) continue;
    const radius = reach * (method === "truth" ? 0.0055 : 0.0035);
    const color = data.colors[method] || "#777777";
    for (const line of lines) scene.add(tube(line, color, radius, method !== "truth"));
  }
  if (fit) {
    controls.target.copy(middle);
    camera.position.copy(middle).addScaledVector(kFrom, distance(reach));
    camera.near = reach / 100;
    camera.far = reach * 100;
    camera.updateProjectionMatrix();
    controls.update();
    camera.updateMatrixWorld();
    const places = subject.flatMap(points).map((point) => point.project(camera));
    page.dataset.fills = Math.max(...places.flatMap(({ x, y }) => [Math.abs(x), Math.abs(y)]));
  }
  render();
}

function legend() {
  const list = document.getElementById("legend");
  list.replaceChildren();
  const known = data.order.filter((method) => method in current().curves);
  const others = Object.keys(current().curves).filter((method) => !data.order.includes(method));
  for (const method of [...known, ...others]) {
    const label = document.createElement("label");
    const check = document.createElement("input");
    check.type = "checkbox";
    check.checked = shown.has(method);
    check.addEventListener("change", () => {
      if (check.checked) shown.add(method);
      else shown.delete(method);
      draw(false);
    });
    const swatch = document.createElement("i");
    swatch.style.background = data.colors[method] || "#777777";
    label.append(check, swatch, " " + method);
    list.append(label);
  }
}

function show(set, index) {
  chosen = { set, scene: index };
  const one = current();
  document.getElementById("scene-name").textContent = one.name;
  document.getElementById("scene-text").textContent = one.text;
  const image = document.getElementById("scene-image");
  image.hidden = !one.image;
  if (one.image) image.src = one.image;
  const selects = [document.getElementById("set"), document.getElementById("scene")];
  selects[0].value = set;
  if (selects[1].dataset.set !== String(set)) {
    selects[1].dataset.set = set;
    selects[1].replaceChildren(
      ...data.sets[set].scenes.map((entry, i) => new Option(entry.name, i)),
    );
  }
  selects[1].value = index;
  legend();
  draw(true);
}

function step(by) {
  const count = data.sets[chosen.set].scenes.length;
  show(chosen.set, (chosen.scene + by + count) % count);
}

function resize() {
  const width = box.clientWidth;
  const height = box.clientHeight;
  renderer.setSize(width, height, false);
  camera.aspect = width / height;
  camera.updateProjectionMatrix();
  render();
}

function begin() {
  camera = new PerspectiveCamera(40, 1, 0.01, 100);
  renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
  box.append(renderer.domElement);
  scene = new Scene();
  controls = new OrbitControls(camera, renderer.domElement);
  controls.addEventListener("change", render);
  const sets = document.getElementById("set");
  sets.replaceChildren(...data.sets.map((entry, i) => new Option(entry.name, i)));
  sets.addEventListener("change", () => show(Number(sets.value), 0));
  const scenes = document.getElementById("scene");
  scenes.addEventListener("change", () => show(chosen.set, Number(scenes.value)));
  document.getElementById("before").addEventListener("click", () => step(-1));
  document.getElementById("next").addEventListener("click", () => step(1));
  new ResizeObserver(resize).observe(box);
  resize();
  show(0, 0);
}

try {
  if (data.sets.length > 0) begin();
  else box.textContent = "No scene has a curve to show.";
  page.dataset.ready = "yes";
} catch (failure) {
  // Mostly a browser without WebGL: tables and plots are there all the same.
  box.textContent = "The 3D view needs WebGL: " + failure.message;
  page.dataset.ready = "no";
}
