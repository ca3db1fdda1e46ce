// The page: the panel, the pointer, what the address asks for.
//   ?model=knot&quality=0&sky=0&angle=40&camera=x,y,z&target=x,y,z&fov=35&panel=0

import { Picture } from "./picture.js";

const element = (id) => document.getElementById(id);
const canvas = element("view");
const asked = new URLSearchParams(location.search);

function say(text) {
  element("message").textContent = text;
  element("message").hidden = !text;
}

function figures(entries) {
  element("figures").replaceChildren(
    ...Object.entries(entries).flatMap(([name, value]) => {
      const dt = document.createElement("dt");
      const dd = document.createElement("dd");
      dt.textContent = name;
      dd.textContent = value;
      return [dt, dd];
    }),
  );
}

function fill(select, names, chosen) {
  select.replaceChildren(
    ...names.map((name, i) => {
      const option = document.createElement("option");
      option.textContent = name;
      option.value = i;
      return option;
    }),
  );
  select.selectedIndex = Math.max(0, chosen);
}

async function start() {
  let picture;
  try {
    picture = new Picture(canvas);
  } catch {
    throw new Error("This page needs WebGL 2, which this browser does not offer.");
  }
  globalThis.prtkitPicture = picture; // for tests
  canvas.addEventListener("webglcontextlost", (event) => {
    event.preventDefault();
    say("The graphics driver was reset; waiting for it.");
  });
  canvas.addEventListener("webglcontextrestored", () => {
    say("");
    picture.draw();
  });

  const response = await fetch("models/models.json");
  if (!response.ok) throw new Error("There are no models: run npm run models.");
  const { models, skies } = await response.json();
  const model = () => models[element("model").selectedIndex];
  const quality = () => model().levels[element("quality").selectedIndex];

  async function showModel(keepCamera) {
    const level = quality();
    const began = performance.now();
    await picture.setModel(level.file, { keepCamera, camera: keepCamera ? undefined : askedCamera ?? model().camera });
    const { prtkit } = picture.gltf.userData;
    figures({
      vertices: prtkit.vertices.toLocaleString("en"),
      "bytes per vertex": level.bytesPerVertexWithBases.toFixed(2),
      "of them attributes": prtkit.bytesPerVertex,
      clusters: prtkit.clusters.components.length,
      order: prtkit.order,
      "error (lit rms)": `${(100 * level.litRms).toFixed(2)} %`,
      file: `${(level.fileBytes / 1e6).toFixed(2)} MB`,
      loaded: `${Math.round(performance.now() - began)} ms`,
    });
  }

  const vector = (name) => asked.get(name)?.split(",").map(Number);
  const askedCamera = asked.has("camera")
    ? { position: vector("camera"), target: vector("target"), fieldOfView: Number(asked.get("fov") ?? 35) }
    : undefined;
  fill(element("model"), models.map((m) => m.title), models.findIndex((m) => m.name === asked.get("model")));
  fill(element("quality"), model().levels.map((l) => l.title), Number(asked.get("quality") ?? 0));
  fill(element("sky"), skies.map((s) => s.title), Number(asked.get("sky") ?? 0));
  if (asked.get("panel") === "0") element("panel").classList.add("hidden");

  const guarded = (work) => async (event) => {
    try {
      say("");
      await work(event);
    } catch (error) {
      say(error.message);
    }
  };
  element("model").onchange = guarded(() => {
    fill(element("quality"), model().levels.map((l) => l.title), element("quality").selectedIndex);
    return showModel(false);
  });
  element("quality").onchange = guarded(() => showModel(true));
  element("sky").onchange = guarded(() => picture.setSky(skies[element("sky").selectedIndex].file));
  element("angle").oninput = () => picture.setAngle((Number(element("angle").value) * Math.PI) / 180);
  element("exposure").oninput = () => picture.setExposure(Number(element("exposure").value));

  // Drag with the right button or with Shift: the light. OrbitControls has the rest.
  let last = null;
  picture.controls.mouseButtons.RIGHT = null;
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener(
    "pointerdown",
    (event) => {
      if (event.button !== 2 && !event.shiftKey) return;
      event.stopImmediatePropagation();
      last = event.clientX;
      canvas.setPointerCapture(event.pointerId);
    },
    { capture: true },
  );
  canvas.addEventListener("pointermove", (event) => {
    if (last === null) return;
    const angle = picture.angle + ((event.clientX - last) / canvas.clientHeight) * Math.PI;
    last = event.clientX;
    element("angle").value = Math.round((Math.atan2(Math.sin(angle), Math.cos(angle)) * 180) / Math.PI);
    picture.setAngle(angle);
  });
  canvas.addEventListener("pointerup", () => (last = null));

  const resize = () => picture.resize(innerWidth, innerHeight, Math.min(devicePixelRatio, 2));
  addEventListener("resize", resize);
  resize();
  picture.setAngle((Number(asked.get("angle") ?? 0) * Math.PI) / 180);
  element("angle").value = asked.get("angle") ?? 0;
  await Promise.all([showModel(false), picture.setSky(skies[element("sky").selectedIndex].file)]);
}

start().catch((error) => say(error.message));
