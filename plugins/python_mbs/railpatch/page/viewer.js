"use strict";
// The patches of a run at any position, drawn on canvases.

const VIRIDIS = ["#440154", "#3b528b", "#21918c", "#5ec962", "#fde725"];
const CIVIDIS = ["#00224e", "#35456c", "#666970", "#948e77", "#c8b866", "#fee838"];
const INFERNO = ["#1b0c41", "#781c6d", "#bb3754", "#ed6925", "#fcb519", "#fcffa4"];

// numbers of a packed array
const numbers = (text, kind) => {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new kind(bytes.buffer);
};

const channels = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));

// 256 colours between given ones
const ramp = (stops) => {
  const known = stops.map(channels);
  return Array.from({ length: 256 }, (_, i) => {
    const at = (i / 255) * (known.length - 1);
    const low = Math.min(Math.floor(at), known.length - 2);
    return known[low].map((c, k) => Math.round(c + (at - low) * (known[low + 1][k] - c)));
  });
};

const digits = (value, count = 3) => {
  if (!Number.isFinite(value)) return "none";
  const size = Math.abs(value);
  let text = size >= 1000 ? value.toFixed(0) : String(+value.toPrecision(count));
  if (size >= 1e5) text = value.toExponential(count - 1);
  return text.replace("-", "\u2212");
};

// a step of 1, 2 or 5 times a power of ten
const niceStep = (range, count) => {
  const rough = range / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((k) => k * power).find((step) => step >= rough);
};

const make = (tag, parent, more = {}) => {
  const element = Object.assign(document.createElement(tag), more);
  parent.append(element);
  return element;
};

// a canvas as sharp as the screen; gives its context in px of the page
const prepare = (canvas, height) => {
  const scale = Math.max(2, devicePixelRatio || 1);
  const width = canvas.parentElement.clientWidth;
  canvas.width = Math.round(width * scale);
  canvas.height = Math.round(height * scale);
  canvas.style.height = `${height}px`;
  const context = canvas.getContext("2d");
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.clearRect(0, 0, width, height);
  context.font = "12px system-ui, sans-serif";
  return [context, width];
};

class PatchViewer {
  constructor(root, data, colours) {
    Object.assign(this, { root, data, colours, cache: new Map(), at: data.start, same: false });
    this.ramps = { pressure: ramp(VIRIDIS), traction: ramp(CIVIDIS), temperature: ramp(INFERNO) };
    this.kinds = ["pressure", "traction", "states", "temperature"].filter((k) => data.kinds[k]);
    this.patch = data.sides.map(() => 0);
    this.build();
  }

  build() {
    const bar = make("div", this.root, { className: "controls" });
    if (this.data.frames.length > 1) {
      const label = make("label", bar, { textContent: "position" });
      label.htmlFor = `${this.root.id}-slider`;
      this.slider = make("input", bar, {
        type: "range", min: 0, max: this.data.frames.length - 1, step: 1, value: this.at,
        id: `${this.root.id}-slider`,
      });
      this.slider.addEventListener("input", () => this.go(+this.slider.value));
      const same = make("label", bar);
      const box = make("input", same, { type: "checkbox" });
      same.append(" same scales at all positions");
      box.addEventListener("change", () => { this.same = box.checked; this.draw(); });
    }
    this.choices = make("span", bar);
    this.where = make("span", bar, { className: "where" });
    const grid = make("div", this.root, { className: "vgrid" });
    grid.style.setProperty("--count", this.kinds.length);
    this.places = [];
    this.data.sides.forEach((side, s) => {
      for (const kind of this.kinds) {
        const cell = make("div", grid, { className: "cell" });
        const title = make("p", cell, { className: "panel-title" });
        const canvas = make("canvas", cell, { tabIndex: -1 });
        canvas.setAttribute("role", "img");
        const place = { s, kind, title, canvas };
        canvas.addEventListener("pointermove", (event) => this.point(place, event));
        canvas.addEventListener("pointerdown", (event) => this.point(place, event));
        canvas.addEventListener("pointerleave", () => { this.hint.textContent = this.hintText; });
        this.places.push(place);
      }
    });
    const key = make("p", this.root, { className: "legend" });
    this.data.states.forEach(([name, color]) => {
      const entry = make("span", key);
      make("i", entry).style.cssText =
        `display:inline-block;width:12px;height:12px;margin-right:6px;background:${color}`;
      entry.append(name);
    });
    this.hintText = "Point at a patch to read its values there.";
    this.hint = make("p", this.root, { className: "hint", textContent: this.hintText });
  }

  go(index) {
    this.at = index;
    this.draw();
  }

  // fields of a packed patch, in mm, MPa and degrees
  patchOf(source, index) {
    const key = `${source === this.data ? "own" : "other"}${index}`;
    if (!this.cache.has(key)) this.cache.set(key, PatchViewer.unpacked(source.patches[index]));
    return this.cache.get(key);
  }

  static unpacked(packed) {
    const found = { x: numbers(packed.x, Float32Array), y: numbers(packed.y, Float32Array) };
    for (const name of ["pressure", "tx", "ty", "temperature"]) {
      if (!packed[name]) continue;
      const [low, step, text] = packed[name];
      const raw = numbers(text, Uint16Array);
      found[name] = Float32Array.from(raw, (v) => low + step * v);
    }
    if (packed.states) found.states = numbers(packed.states, Uint8Array);
    if (found.tx) found.traction = found.tx.map((v, i) => Math.hypot(v, found.ty[i]));
    return found;
  }

  // the patch that is shown of a side, and that of the other log
  chosen(s) {
    const own = this.data.frames[this.at][s];
    const index = own[Math.min(this.patch[s], own.length - 1)];
    const found = { own: index === undefined ? null : this.patchOf(this.data, index), other: null };
    const other = this.data.other;
    if (other) {
      const at = this.data.at[this.at];
      let best = 0;
      other.at.forEach((v, i) => {
        if (Math.abs(v - at) < Math.abs(other.at[best] - at)) best = i;
      });
      const theirs = other.frames[best][s];
      const place = theirs[Math.min(this.patch[s], theirs.length - 1)];
      if (place !== undefined) found.other = this.patchOf(other, place);
    }
    return found;
  }

  // mm, what all that is shown needs: [left, right, low, high]
  static box(patches) {
    const box = [Infinity, -Infinity, Infinity, -Infinity];
    for (const patch of patches) {
      if (!patch) continue;
      patch.y.forEach((y, j) => patch.x.forEach((x, i) => {
        if (patch.pressure[j * patch.x.length + i] <= 0) return;
        box[0] = Math.min(box[0], x); box[1] = Math.max(box[1], x);
        box[2] = Math.min(box[2], y); box[3] = Math.max(box[3], y);
      }));
    }
    if (!Number.isFinite(box[0])) return [-1, 1, -1, 1];
    const pad = 0.04 * Math.max(box[1] - box[0], box[3] - box[2]) + 0.3;
    return [box[0] - pad, box[1] + pad, box[2] - pad, box[3] + pad];
  }

  tops(patches) {
    const top = { states: [0, 1] };
    for (const kind of ["pressure", "traction", "temperature"]) {
      let low = kind === "temperature" ? Infinity : 0;
      let high = kind === "temperature" ? -Infinity : 0;
      for (const patch of patches) {
        if (!patch || !patch[kind]) continue;
        for (const v of patch[kind]) { if (v > high) high = v; if (v < low) low = v; }
      }
      top[kind] = [low, high];
    }
    return top;
  }

  draw() {
    const pairs = this.data.sides.map((_, s) => this.chosen(s));
    const all = this.same ? this.everything() : null;
    const seen = all ? all.patches : pairs.flatMap((pair) => [pair.own, pair.other]);
    const top = this.tops(seen);
    this.where.textContent = this.data.text[this.at];
    this.select();
    for (const place of this.places) {
      const pair = pairs[place.s];
      const box = PatchViewer.box(all ? all.bySide[place.s] : [pair.own, pair.other]);
      this.cell(place, pair, box, top);
    }
  }

  everything() {
    const bySide = this.data.sides.map((_, s) => this.data.frames.flatMap((frame) =>
      frame[s].map((index) => this.patchOf(this.data, index))));
    return { bySide, patches: bySide.flat() };
  }

  // one choice for each side with more than one patch here
  select() {
    this.choices.textContent = "";
    this.data.sides.forEach((side, s) => {
      const count = this.data.frames[this.at][s].length;
      if (count < 2) return;
      const label = make("label", this.choices, { textContent: `${side}: ` });
      const list = make("select", label);
      for (let k = 0; k < count; k += 1) {
        make("option", list, { value: k, textContent: `patch ${k + 1} of ${count}` });
      }
      list.value = Math.min(this.patch[s], count - 1);
      list.addEventListener("change", () => { this.patch[s] = +list.value; this.draw(); });
    });
  }

  cell(place, pair, box, top) {
    const { kind, canvas, s } = place;
    const ink = this.colours();
    const aspect = (box[3] - box[2]) / (box[1] - box[0]);
    const room = canvas.parentElement.clientWidth - 96;
    const height = Math.round(Math.min(360, Math.max(190, room * aspect))) + 44;
    const [context, width] = prepare(canvas, height);
    const frame = { left: 44, top: 6, width: width - 96, height: height - 44 };
    const scale = Math.min(frame.width / (box[1] - box[0]), frame.height / (box[3] - box[2]));
    const middle = [frame.left + frame.width / 2, frame.top + frame.height / 2];
    const centre = [(box[0] + box[1]) / 2, (box[2] + box[3]) / 2];
    const px = (x) => middle[0] + scale * (x - centre[0]);
    const py = (y) => middle[1] + scale * (y - centre[1]);
    Object.assign(place, { px, py, scale, frame });
    const names = this.data.kinds;
    const side = this.data.sides[s];
    place.title.textContent = `${side ? `${side}: ` : ""}${names[kind].name}`;
    canvas.setAttribute("aria-label", place.title.textContent);
    context.save();
    context.beginPath();
    context.rect(frame.left, frame.top, frame.width, frame.height);
    context.clip();
    if (pair.own) this.fields(context, pair.own, kind, top[kind], px, py);
    if (pair.own && kind === "traction") this.arrows(context, pair.own, px, py, scale);
    if (pair.other) this.outline(context, pair.other, kind, px, py, ink);
    context.restore();
    PatchViewer.axes(context, frame, scale, middle, centre, ink);
    if (!pair.own) {
      context.fillStyle = ink.soft;
      context.textAlign = "center";
      context.fillText("no contact logged here", middle[0], middle[1]);
    } else if (kind !== "states") this.bar(context, frame, width, kind, top[kind], ink);
  }

  static edges(values) {
    const n = values.length;
    if (n === 1) return [values[0] - 0.1, values[0] + 0.1];
    const found = [values[0] - (values[1] - values[0]) / 2];
    for (let i = 1; i < n; i += 1) found.push((values[i - 1] + values[i]) / 2);
    return [...found, values[n - 1] + (values[n - 1] - values[n - 2]) / 2];
  }

  fields(context, patch, kind, [low, high], px, py) {
    const [xs, ys] = [PatchViewer.edges(patch.x), PatchViewer.edges(patch.y)];
    const values = patch[kind];
    if (!values) return;
    patch.y.forEach((_, j) => patch.x.forEach((__, i) => {
      const k = j * patch.x.length + i;
      if (patch.pressure[k] <= 0) return;
      if (kind === "states") context.fillStyle = this.data.states.find((e) => e[2] === values[k])?.[1]
        || "transparent";
      else {
        const at = high > low ? (values[k] - low) / (high - low) : 0;
        const colour = this.ramps[kind][Math.max(0, Math.min(255, Math.round(255 * at)))];
        context.fillStyle = `rgb(${colour.join()})`;
      }
      const [a, b] = [px(xs[i]), py(ys[j])];
      context.fillRect(a, b, px(xs[i + 1]) - a + 0.35, py(ys[j + 1]) - b + 0.35);
    }));
  }

  arrows(context, patch, px, py, scale) {
    const size = Math.max(...patch.traction);
    if (!(size > 0)) return;
    const step = [patch.x, patch.y].map((v) => Math.max(1, Math.ceil(v.length / 14)));
    const reach = 1.5 * Math.min(
      step[0] * Math.abs(px(patch.x[1] ?? 1) - px(patch.x[0])),
      step[1] * Math.abs(py(patch.y[1] ?? 1) - py(patch.y[0]))) / size;
    for (let j = step[1] >> 1; j < patch.y.length; j += step[1]) {
      for (let i = step[0] >> 1; i < patch.x.length; i += step[0]) {
        const k = j * patch.x.length + i;
        if (patch.traction[k] < 0.02 * size) continue;
        const [x, y] = [px(patch.x[i]), py(patch.y[j])];
        const [dx, dy] = [reach * patch.tx[k], reach * patch.ty[k]];
        const length = Math.hypot(dx, dy);
        const [ux, uy] = [dx / length, dy / length];
        const head = Math.min(5, 0.5 * length);
        context.beginPath();
        context.moveTo(x - dx / 2, y - dy / 2);
        context.lineTo(x + dx / 2, y + dy / 2);
        for (const turn of [0.5, -0.5]) {
          context.moveTo(x + dx / 2, y + dy / 2);
          context.lineTo(x + dx / 2 - head * (ux - turn * uy), y + dy / 2 - head * (uy + turn * ux));
        }
        for (const [line, colour] of [[3, "rgba(0,0,0,0.55)"], [1.3, "#ffffff"]]) {
          context.lineWidth = line;
          context.strokeStyle = colour;
          context.stroke();
        }
      }
    }
  }

  // edges of the other log's contact, and between its states
  outline(context, patch, kind, px, py, ink) {
    const [xs, ys] = [PatchViewer.edges(patch.x), PatchViewer.edges(patch.y)];
    const [n, m] = [patch.x.length, patch.y.length];
    const value = (i, j) => {
      if (i < 0 || j < 0 || i >= n || j >= m || patch.pressure[j * n + i] <= 0) return 0;
      return kind === "states" && patch.states ? patch.states[j * n + i] : 1;
    };
    context.beginPath();
    for (let j = 0; j <= m; j += 1) {
      for (let i = 0; i <= n; i += 1) {
        if (j < m && value(i - 1, j) !== value(i, j)) {
          context.moveTo(px(xs[i]), py(ys[j]));
          context.lineTo(px(xs[i]), py(ys[j + 1]));
        }
        if (i < n && value(i, j - 1) !== value(i, j)) {
          context.moveTo(px(xs[i]), py(ys[j]));
          context.lineTo(px(xs[i + 1]), py(ys[j]));
        }
      }
    }
    context.lineWidth = 1.8;
    context.strokeStyle = ink.bad;
    context.stroke();
  }

  static axes(context, frame, scale, middle, centre, ink) {
    context.strokeStyle = ink.line;
    context.lineWidth = 1;
    context.strokeRect(frame.left, frame.top, frame.width, frame.height);
    context.fillStyle = ink.soft;
    const wide = frame.width / scale, high = frame.height / scale;
    const [stepX, stepY] = [niceStep(wide, 5), niceStep(high, 5)];
    context.textAlign = "center";
    context.textBaseline = "top";
    for (let v = Math.ceil((centre[0] - wide / 2) / stepX) * stepX; v <= centre[0] + wide / 2; v += stepX) {
      const x = middle[0] + scale * (v - centre[0]);
      context.beginPath();
      context.moveTo(x, frame.top + frame.height);
      context.lineTo(x, frame.top + frame.height + 4);
      context.stroke();
      context.fillText(digits(Math.abs(v) < 1e-9 ? 0 : v), x, frame.top + frame.height + 6);
    }
    context.fillText("along rolling [mm]", middle[0], frame.top + frame.height + 21);
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (let v = Math.ceil((centre[1] - high / 2) / stepY) * stepY; v <= centre[1] + high / 2; v += stepY) {
      const y = middle[1] + scale * (v - centre[1]);
      context.beginPath();
      context.moveTo(frame.left - 4, y);
      context.lineTo(frame.left, y);
      context.stroke();
      context.fillText(digits(Math.abs(v) < 1e-9 ? 0 : v), frame.left - 6, y);
    }
    context.save();
    context.translate(8, middle[1]);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText("lateral [mm]", 0, 0);
    context.restore();
  }

  bar(context, frame, width, kind, [low, high], ink) {
    const [x, colours] = [frame.left + frame.width + 6, this.ramps[kind]];
    for (let i = 0; i < 256; i += 1) {
      context.fillStyle = `rgb(${colours[255 - i].join()})`;
      context.fillRect(x, frame.top + (i * frame.height) / 256, 8, frame.height / 256 + 0.6);
    }
    context.fillStyle = ink.soft;
    context.textAlign = "left";
    context.textBaseline = "top";
    context.fillText(digits(high, 3), x + 11, frame.top);
    context.textBaseline = "bottom";
    context.fillText(digits(low, 3), x + 11, frame.top + frame.height);
  }

  // values below the pointer
  point(place, event) {
    const pair = this.chosen(place.s);
    const rect = place.canvas.getBoundingClientRect();
    const [x, y] = [event.clientX - rect.left, event.clientY - rect.top];
    const texts = [];
    let mm = "";
    for (const [name, patch] of [["", pair.own], [this.data.other?.name, pair.other]]) {
      if (!patch) continue;
      const nearest = (values, to, at) => {
        let best = -1, least = Infinity;
        values.forEach((v, i) => {
          const away = Math.abs(to(v) - at);
          if (away < least) [best, least] = [i, away];
        });
        const step = values.length > 1 ? Math.abs(to(values[1]) - to(values[0])) : 10;
        return least <= step ? best : -1;
      };
      const [i, j] = [nearest(patch.x, place.px, x), nearest(patch.y, place.py, y)];
      const k = j * patch.x.length + i;
      if (i < 0 || j < 0 || !(patch.pressure[k] > 0)) {
        texts.push(`${name ? `${name}: ` : ""}outside the contact`);
        continue;
      }
      mm = `x ${digits(patch.x[i])} mm, y ${digits(patch.y[j])} mm. `;
      const parts = [`pressure ${digits(patch.pressure[k], 4)} MPa`];
      if (patch.tx) {
        parts.push(`traction ${digits(patch.traction[k])} MPa (x ${digits(patch.tx[k])}, ` +
          `y ${digits(patch.ty[k])})`);
      }
      if (patch.states) parts.push(this.data.states.find((e) => e[2] === patch.states[k])?.[0] || "");
      if (patch.temperature) parts.push(`${digits(patch.temperature[k])} \u00b0C`);
      texts.push(`${name ? `${name}: ` : ""}${parts.filter(Boolean).join(", ")}`);
    }
    const side = this.data.sides[place.s];
    this.hint.textContent = `${side ? `${side}, ` : ""}${mm}${texts.join("; ")}`;
  }
}
