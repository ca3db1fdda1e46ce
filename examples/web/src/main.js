// The page: the panel, the pointer, the parameters of the address.
//   ?model=knot&quality=0&sky=0&suns=1&window=auto&angle=40&exposure=0&shine=0&figure=1&spheres=0&probes=0&split=0.5&camera=x,y,z&target=x,y,z&fov=35&panel=0

import { addressOf, vectorOf } from "./address.js";
import { Picture } from "./picture.js";
import { WINDOWS } from "./windows.js";

const element = (id) => document.getElementById(id);
const canvas = element("view");
const asked = new URLSearchParams(location.search);

const loads = new Map(); // loads in progress, and the fraction loaded

function showLoads() {
  const shares = [...loads.values()];
  element("loads").textContent = `Loading ${[...loads.keys()].join(", ")} …`;
  element("share").value = shares.reduce((sum, share) => sum + share, 0) / Math.max(1, shares.length);
  element("loading").hidden = loads.size === 0;
}

/**
 * Shows that `what` is loading until `work` ends; first waits for the browser to show it. `work` gets a
 * function that reports its progress.
 */
async function loading(what, work) {
  loads.set(what, 0);
  showLoads();
  await new Promise((shown) => requestAnimationFrame(() => setTimeout(shown)));
  try {
    return await work(({ loaded, total }) => {
      if (total > 0) loads.set(what, Math.min(1, loaded / total));
      showLoads();
    });
  } finally {
    loads.delete(what);
    showLoads();
  }
}

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

function slider(name, min, value, max, change) {
  const label = document.createElement("label");
  const text = document.createElement("span");
  const input = document.createElement("input");
  text.textContent = text.title = name;
  Object.assign(input, { type: "range", min, max, step: 0.01, value });
  input.oninput = () => change(Number(input.value));
  label.append(text, input);
  return label;
}

async function start() {
  let picture;
  try {
    const phone = matchMedia("(pointer: coarse)").matches;
    picture = new Picture(canvas, { shadowMapSize: phone ? 1024 : 2048 });
  } catch {
    throw new Error("This page needs WebGL 2, which this browser does not support.");
  }
  globalThis.prtkitPicture = picture; // for tests
  canvas.addEventListener("webglcontextlost", (event) => {
    event.preventDefault();
    say("The graphics driver was reset. The picture returns when it is available again.");
  });
  canvas.addEventListener("webglcontextrestored", () => {
    say("");
    picture.draw();
  });

  const response = await fetch("models/models.json");
  if (!response.ok) throw new Error("There are no models: run npm run models.");
  const { models, skies, figure } = await response.json();
  const model = () => models[element("model").selectedIndex];
  const quality = () => model().levels[element("quality").selectedIndex];
  const sky = () => skies[element("sky").selectedIndex];

  let askedCamera = asked.has("camera")
    ? { position: vectorOf(asked, "camera"), target: vectorOf(asked, "target"), fieldOfView: Number(asked.get("fov") ?? 35) }
    : undefined;

  function showFigures({ bytesPerVertexWithBases, litRms, fileBytes }, milliseconds) {
    const { prtkit } = picture.gltf.userData;
    const ofVertices = () => ({
      vertices: prtkit.vertices.toLocaleString("en"),
      "bytes per vertex": (bytesPerVertexWithBases ?? prtkit.bytesPerVertex).toFixed(2),
      "attribute bytes per vertex": prtkit.bytesPerVertex,
    });
    const ofTexels = () => ({ texels: prtkit.texels.toLocaleString("en"), "bytes per texel": prtkit.bytesPerTexel });
    const { instances } = prtkit;
    const ofInstances = () => ({
      instances: instances.count.toLocaleString("en"),
      "bytes per instance": instances.bytesPerInstance,
      "constant bytes per instance": Math.round(instances.constantsBytesPerInstance).toLocaleString("en"),
    });
    figures({
      ...(prtkit.maps ? ofTexels() : ofVertices()),
      ...(instances ? ofInstances() : {}),
      ...(prtkit.lobes ? { "lobes per vertex": prtkit.lobes } : { clusters: prtkit.clusters.components.length }),
      order: prtkit.order,
      ...(prtkit.volume ? { probes: prtkit.volume.probes.toLocaleString("en") } : {}),
      ...(litRms === undefined ? {} : { "error (lit rms)": `${(100 * litRms).toFixed(2)} %` }),
      file: `${(fileBytes / 1e6).toFixed(2)} MB`,
      loaded: `${Math.round(milliseconds)} ms`,
    });
  }

  async function showModel(keepCamera) {
    const level = quality();
    const camera = keepCamera ? undefined : askedCamera ?? model().camera;
    askedCamera = undefined; // a different model has a different camera
    const began = performance.now();
    try {
      await loading(model().title, (progress) => picture.setModel(level.file, { keepCamera, camera, way: model().way, clip: model().clip, progress }));
    } catch (error) {
      throw new Error(`${model().title}: ${error.message}`);
    }
    showFigures(level, performance.now() - began);
    showSuns();
    showLamps();
    showMoving();
    await showBefore();
  }

  async function showSky() {
    await loading(sky().title, (progress) => picture.setSky(sky(), progress));
    showSuns();
    showAddress();
  }

  /** Shows the model before compression next to the current one, if it is selected and exists. */
  async function showBefore() {
    const { before } = model();
    element("compare").disabled = !before;
    element("lossless").textContent = before
      ? `left: ${before.bytes} bytes per vertex, error ${(100 * before.litRms).toFixed(2)} %; right: the selected quality`
      : "";
    const comparing = Boolean(before) && element("compare").checked;
    element("split").hidden = element("lossless").hidden = !comparing;
    if (comparing) await loading(`${model().title} before compression`, (progress) => picture.setBefore(before.file, progress));
    else await picture.setBefore(null);
    showAddress();
  }

  /** Stores a link to the current state in the address of the page, shortly after a change. */
  function showAddress() {
    clearTimeout(showAddress.waiting);
    showAddress.waiting = setTimeout(() => {
      const isServed = (entry, file) => file && !file.startsWith("blob:") && entry !== undefined;
      const { selectedIndex } = element("sky");
      const names = {
        model: isServed(model(), quality()?.file) ? model().name : undefined,
        quality: element("quality").selectedIndex,
        sky: isServed(sky(), sky()?.file) ? selectedIndex : undefined,
        comparing: !element("split").hidden,
        panel: asked.get("panel"),
      };
      history.replaceState(null, "", addressOf(picture, names));
    }, 200);
  }

  /** Shows a slider for each lamp and for the daylight; nothing for a model without lamps. */
  function showLamps() {
    const { lamps } = picture.gltf.userData.prtkit;
    element("lamps").hidden = lamps.length === 0;
    element("lamps").replaceChildren(
      slider("daylight", 0, Math.sqrt(picture.daylight), 1, (value) => picture.setDaylight(value ** 2)),
      ...lamps.map((name) => slider(name, 0, 1, 2, (value) => picture.setLamp(name, value))),
    );
    if (lamps.length === 0) picture.setDaylight(1);
  }

  /** Enables the controls of moving objects, or shows why the model does not support them. */
  function showMoving() {
    const { volume } = picture.gltf.userData.prtkit;
    element("moving").disabled = !volume;
    element("unmoving").hidden = Boolean(volume);
    element("unmoving").textContent = "This model has no volume for moving objects: bake it with prt bake --volume.";
  }

  /** Loads the figure when it is first requested. */
  async function setFigure(shown) {
    picture.setMoving("figure", shown);
    if (!shown || !figure || setFigure.isLoaded) return;
    setFigure.isLoaded = true;
    await loading("walking figure", (progress) => picture.moving.load(figure, progress));
    picture.draw();
  }

  /** Enables the switch of separate suns if they are possible. */
  function showSuns() {
    element("suns").disabled = !picture.canSeparateSuns;
  }

  const fillModels = (chosen) => fill(element("model"), models.map((m) => m.title), chosen);
  const fillSkies = (chosen) => fill(element("sky"), skies.map((s) => s.title), chosen);
  const fillQualities = (chosen) =>
    fill(
      element("quality"),
      model().levels.map(({ title, bytesPerVertexWithBases: bytes }) =>
        bytes === undefined ? title : `${title}: ${bytes.toFixed(1)} bytes per vertex`,
      ),
      Math.min(chosen, model().levels.length - 1),
    );

  async function openModel(file) {
    const url = URL.createObjectURL(file);
    const level = { title: "as in the file", file: url, fileBytes: file.size };
    const began = performance.now();
    await loading(file.name, (progress) => picture.setModel(url, { progress }));
    models.push({ name: file.name, title: file.name, levels: [level] });
    fillModels(models.length - 1);
    fillQualities(0);
    showFigures(level, performance.now() - began);
    showSuns();
    showLamps();
    showMoving();
    await showBefore();
  }

  /** `image`, `light`: a sky and its light file, or one of both. */
  async function openSky({ image, light }) {
    const entry = { title: (image ?? light).name };
    if (image) Object.assign(entry, { file: URL.createObjectURL(image), exr: /\.exr$/i.test(image.name) });
    if (light) entry.light = URL.createObjectURL(light);
    await loading(entry.title, (progress) => picture.setSky(entry, progress));
    skies.push(entry);
    fillSkies(skies.length - 1);
    showSuns();
    showAddress();
  }

  /**
   * Shows the user's files, and adds them to their lists on success. A light file belongs to the sky with an
   * equal name.
   */
  async function openFiles(files) {
    const stem = ({ name }) => name.replace(/\.[^.]*$/, "");
    const ofOne = (a, b) => stem(a) === stem(b);
    const isLight = ({ name }) => /\.json$/i.test(name);
    const isImage = ({ name }) => /\.(hdr|exr)$/i.test(name);
    const paired = (file) => isLight(file) && files.some((other) => isImage(other) && ofOne(other, file));
    for (const file of files.filter((other) => !paired(other)))
      try {
        if (/\.glb$/i.test(file.name)) await openModel(file);
        else if (isImage(file)) await openSky({ image: file, light: files.find((other) => isLight(other) && ofOne(other, file)) });
        else if (isLight(file)) await openSky({ light: file });
        else throw new Error("the file is neither a model (.glb) nor a sky (.hdr, .exr) nor a light file (.json)");
      } catch (error) {
        throw new Error(`${file.name}: ${error.message}`);
      }
  }

  const linked = (change) => (event) => {
    change(event);
    showAddress();
  };

  const guarded = (work) => async (event) => {
    try {
      say("");
      await work(event);
    } catch (error) {
      say(error.message);
    }
  };

  fillModels(models.findIndex((m) => m.name === asked.get("model")));
  fillQualities(Number(asked.get("quality") ?? 0));
  fillSkies(Number(asked.get("sky") ?? 0));
  const windows = Object.keys(WINDOWS);
  fill(element("window"), Object.values(WINDOWS).map((w) => w.title), windows.indexOf(asked.get("window")));
  picture.window = windows[element("window").selectedIndex];
  element("suns").checked = picture.separateSuns = asked.get("suns") !== "0";
  picture.setShine((element("shine").checked = asked.get("shine") === "1"));
  picture.setExposure(Number((element("exposure").value = asked.get("exposure") ?? 0)));
  picture.still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  for (const [part, usual] of [["spheres", "0"], ["probes", "0"], ["figure", "1"]])
    element(part).checked = (asked.get(part) ?? usual) === "1";
  for (const part of ["spheres", "probes"]) picture.setMoving(part, element(part).checked);
  element("compare").checked = asked.has("split");
  picture.setSplit(Number((element("split").value = asked.get("split") ?? 0.5)));
  if (asked.get("panel") === "0") element("panel").classList.add("hidden");
  element("panel").open = !matchMedia("(max-width: 600px)").matches;

  element("model").onchange = guarded(() => {
    fillQualities(element("quality").selectedIndex);
    return showModel(false);
  });
  element("quality").onchange = guarded(() => showModel(true));
  element("sky").onchange = guarded(showSky);
  element("window").onchange = linked(() => picture.setWindow(windows[element("window").selectedIndex]));
  element("suns").onchange = linked(() => picture.setSeparateSuns(element("suns").checked));
  element("shine").onchange = linked(() => picture.setShine(element("shine").checked));
  for (const part of ["spheres", "probes"]) element(part).onchange = linked(() => picture.setMoving(part, element(part).checked));
  element("figure").onchange = guarded(() => {
    showAddress();
    return setFigure(element("figure").checked);
  });
  element("angle").oninput = linked(() => picture.setAngle((Number(element("angle").value) * Math.PI) / 180));
  element("exposure").oninput = linked(() => picture.setExposure(Number(element("exposure").value)));
  element("split").oninput = linked(() => picture.setSplit(Number(element("split").value)));
  element("compare").onchange = guarded(showBefore);
  picture.controls.addEventListener("end", showAddress);
  canvas.addEventListener("pointerup", showAddress);
  element("rotating").addEventListener("change", showAddress);
  element("link").onclick = guarded(async () => {
    await navigator.clipboard.writeText(location.href);
    element("link").textContent = "Copied";
    setTimeout(() => (element("link").textContent = "Copy a link to this view"), 2000);
  });
  element("files").onchange = guarded(() => openFiles([...element("files").files]));

  addEventListener("dragover", (event) => {
    event.preventDefault();
    element("drop").hidden = false;
  });
  addEventListener("dragleave", (event) => {
    if (!event.relatedTarget) element("drop").hidden = true; // left the page
  });
  addEventListener("drop", guarded((event) => {
    event.preventDefault();
    element("drop").hidden = true;
    return openFiles([...event.dataTransfer.files]);
  }));

  rotateLightByDragging(picture);
  rotateLightByItself(picture);
  const stage = element("stage");
  const resize = () => picture.resize(stage.clientWidth, stage.clientHeight, Math.min(devicePixelRatio, 2));
  new ResizeObserver(resize).observe(stage);
  resize();
  picture.setAngle((Number(asked.get("angle") ?? 0) * Math.PI) / 180);
  element("angle").value = asked.get("angle") ?? 0;
  await Promise.all([showModel(false), showSky(), setFigure(element("figure").checked)]);
}

function rotateLight(picture, angle) {
  element("angle").value = Math.round((Math.atan2(Math.sin(angle), Math.cos(angle)) * 180) / Math.PI);
  picture.setAngle(angle);
}

const ROTATION_PER_SECOND = Math.PI / 12;

/** Rotates the light continuously while the option is selected. */
function rotateLightByItself(picture) {
  let before = null;
  const step = (now) => {
    if (!element("rotating").checked) return;
    // A slow frame, or a hidden page, does not cause a jump.
    if (before !== null) rotateLight(picture, picture.angle + ROTATION_PER_SECOND * Math.min((now - before) / 1000, 0.1));
    before = now;
    requestAnimationFrame(step);
  };
  element("rotating").onchange = () => {
    before = null;
    requestAnimationFrame(step);
  };
}

/** Dragging with the right button or with Shift rotates the light. OrbitControls handles all other dragging. */
function rotateLightByDragging(picture) {
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
    rotateLight(picture, angle);
  });
  canvas.addEventListener("pointerup", () => (last = null));
}

start().catch((error) => say(error.message));
