"use strict";
// Cases as lines over parallel axes. A range dragged along an axis picks cases; a click ends it.
// Of a logarithmic axis values, low and high are logarithms.
class ParallelAxes {
  constructor(root, data, colours) {
    Object.assign(this, { root, colours, ramp: ramp(VIRIDIS), ranges: new Map() });
    this.axes = data.axes.map((axis) => ({ ...axis, values: numbers(axis.values, Float32Array) }));
    for (const axis of this.axes) {
      if (axis.logarithmic) axis.values = axis.values.map(Math.log10);
      const known = axis.values.filter(Number.isFinite);
      axis.low = known.reduce((a, b) => Math.min(a, b), Infinity);
      axis.high = known.reduce((a, b) => Math.max(a, b), -Infinity);
      if (!(axis.high > axis.low)) [axis.low, axis.high] = [axis.low - 0.5, axis.low + 0.5];
    }
    this.color = this.axes[data.color];
    this.canvas = make("canvas", root);
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", "all cases as lines over parallel axes");
    this.canvas.style.cursor = "ns-resize";
    this.hint = make("p", root, { className: "hint" });
    this.canvas.addEventListener("pointerdown", (event) => this.begin(event));
    this.canvas.addEventListener("pointermove", (event) => this.move(event));
    addEventListener("pointerup", () => { this.held = null; });
  }

  place(event) {
    const rect = this.canvas.getBoundingClientRect();
    const x = event.clientX - rect.left;
    let best = 0;
    this.at.forEach((v, i) => { if (Math.abs(v - x) < Math.abs(this.at[best] - x)) best = i; });
    const y = event.clientY - rect.top;
    const share = Math.min(1, Math.max(0, 1 - (y - this.top) / (this.bottom - this.top)));
    return [this.axes[best], share];
  }

  begin(event) {
    const [axis, share] = this.place(event);
    this.held = [axis, share];
    this.ranges.delete(axis);
    this.draw();
  }

  move(event) {
    if (!this.held) return;
    const [axis, from] = this.held;
    const to = this.place(event)[1];
    if (Math.abs(to - from) > 0.01) this.ranges.set(axis, [Math.min(from, to), Math.max(from, to)]);
    this.draw();
  }

  share(axis, i) {
    return (axis.values[i] - axis.low) / (axis.high - axis.low);
  }

  draw() {
    const ink = this.colours();
    const height = 420;
    const [context, width] = prepare(this.canvas, height);
    this.width = width;
    const gap = (width - 120) / Math.max(1, this.axes.length - 1);
    const names = this.axes.map((axis) => this.broken(context, axis.name, gap - 8));
    const most = names.reduce((count, lines) => Math.max(count, lines.length), 1);
    [this.top, this.bottom] = [22 + 14 * most, height - 26];
    this.at = this.axes.map((_, i) => 50 + i * gap);
    const y = (share) => this.bottom - share * (this.bottom - this.top);
    let count = 0;
    const total = this.axes[0].values.length;
    const chosen = (i) => [...this.ranges].every(([axis, [low, high]]) => {
      const share = this.share(axis, i);
      return share >= low - 1e-6 && share <= high + 1e-6;
    });
    context.lineWidth = 1;
    for (const pass of [false, true]) {
      for (let i = 0; i < total; i += 1) {
        if (chosen(i) !== pass) continue;
        count += pass ? 1 : 0;
        const colour = this.ramp[Math.round(255 * Math.min(1, Math.max(0, this.share(this.color, i))))];
        context.strokeStyle = pass && colour ? `rgba(${colour.join()},0.55)` : ink.grid;
        context.beginPath();
        this.axes.forEach((axis, k) => {
          const share = this.share(axis, i);
          if (!Number.isFinite(share)) return;
          context[k ? "lineTo" : "moveTo"](this.at[k], y(share));
        });
        context.stroke();
      }
    }
    this.axes.forEach((axis, k) => {
      context.strokeStyle = ink.soft;
      context.beginPath();
      context.moveTo(this.at[k], this.top);
      context.lineTo(this.at[k], this.bottom);
      context.stroke();
      const range = this.ranges.get(axis);
      if (range) {
        context.fillStyle = ink.link;
        context.fillRect(this.at[k] - 4, y(range[1]), 8, y(range[0]) - y(range[1]));
      }
      this.labels(context, axis, names[k], k, gap, y, ink);
    });
    this.hint.textContent = `${count} of ${total} cases. Drag along an axis to choose cases, click it to ` +
      `let them go. Colour: ${this.color.name}, from ${digits(this.end("low"))}, dark, to ` +
      `${digits(this.end("high"))}, light.`;
  }

  // of what colours tell
  end(name) {
    return this.color.logarithmic ? 10 ** this.color[name] : this.color[name];
  }

  // a name over as many lines as fit between two axes
  broken(context, name, room) {
    const lines = [""];
    for (const part of name.split(/(?<=[._\s])/)) {
      const longer = lines[lines.length - 1] + part;
      if (context.measureText(longer).width > room && lines[lines.length - 1]) lines.push(part);
      else lines[lines.length - 1] = longer;
    }
    return lines;
  }

  // a mark at each power of ten
  decades(context, axis, k, y) {
    context.beginPath();
    for (let power = Math.ceil(axis.low); power <= axis.high; power += 1) {
      const at = y((power - axis.low) / (axis.high - axis.low));
      context.moveTo(this.at[k] - 4, at);
      context.lineTo(this.at[k] + 4, at);
    }
    context.stroke();
  }

  labels(context, axis, lines, k, gap, y, ink) {
    context.fillStyle = ink.soft;
    context.textAlign = "center";
    context.textBaseline = "bottom";
    lines.forEach((line, i) => {
      const up = this.top - 20 - 14 * (lines.length - 1 - i);
      const half = context.measureText(line).width / 2;
      const at = Math.min(Math.max(this.at[k], half), this.width - half);
      context.fillText(line, at, up);
    });
    const ends = axis.texts ? [] : [[1, axis.high, -4], [0, axis.low, 18]];
    for (const [share, value, off] of ends) {
      const shown = axis.logarithmic ? 10 ** value : value;
      context.fillText(digits(shown), this.at[k], y(share) + off, gap - 6);
    }
    if (axis.logarithmic) this.decades(context, axis, k, y);
    context.textAlign = "left";
    (axis.texts || []).forEach((text, i) => {
      context.fillText(text, this.at[k] + 5, y((i - axis.low) / (axis.high - axis.low)) + 6, gap - 8);
    });
  }
}
