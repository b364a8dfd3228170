"use strict";
// Draws the figures and viewers of a page, in the colours of its style, again where these or the
// width change. window.drawn: resolved when all that can be seen has been drawn.
(() => {
  const plots = new Map(); // element -> {panel, figure}
  const groups = new Map(); // figure -> Set of legend groups that are off

  const unpack = async (id) => {
    const text = document.getElementById(id).textContent;
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Response(stream).text();
  };

  const colours = () => {
    const style = getComputedStyle(document.documentElement);
    return new Proxy({}, { get: (_, name) => style.getPropertyValue(`--${name}`).trim() });
  };

  // an axis with the page's colours
  const axis = (own, ink) => ({
    showline: true, mirror: true, ticks: "outside", automargin: true, zeroline: true, ...own,
    gridcolor: ink.grid, linecolor: ink.line, tickcolor: ink.line, zerolinecolor: ink.line,
    title: { ...(own.title || {}), standoff: 6 },
    minor: own.minor ? { ...own.minor, gridcolor: ink.grid } : undefined,
  });

  const layoutOf = (panel, ink) => ({
    ...panel.layout,
    xaxis: axis(panel.layout.xaxis || {}, ink),
    yaxis: axis(panel.layout.yaxis || {}, ink),
    height: panel.height,
    margin: { l: 8, r: 10, t: 8, b: 8, pad: 0 },
    paper_bgcolor: "rgba(0,0,0,0)",
    plot_bgcolor: "rgba(0,0,0,0)",
    showlegend: false,
    font: { color: ink.soft, family: "system-ui, sans-serif", size: 12.5 },
    modebar: { bgcolor: "rgba(0,0,0,0)", color: ink.soft, orientation: "v" },
    hoverlabel: { bgcolor: ink.ink, font: { color: ink.ground, size: 13 }, align: "left" },
    hovermode: "closest",
  });

  const CONFIG = {
    displaylogo: false, responsive: true, displayModeBar: "hover", showSendToCloud: false,
    modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"],
  };

  const visible = (element) => element.offsetParent !== null && element.clientWidth > 0;

  const shown = (panel, figure) => {
    const off = groups.get(figure);
    return panel.traces.map((trace) => {
      const away = off && off.has(trace.legendgroup || trace.name);
      return away ? { ...trace, visible: false } : trace;
    });
  };

  const draw = async (element) => {
    const { panel, figure } = plots.get(element);
    await Plotly.react(element, shown(panel, figure), layoutOf(panel, colours()), CONFIG);
    if (!element.dataset.drawn) follow(element);
    else await Plotly.Plots.resize(element);
    element.dataset.drawn = "1";
  };

  // panels of a figure over the same quantity move together
  const follow = (element) => {
    const { panel, figure } = plots.get(element);
    let busy = false;
    element.on("plotly_relayout", (change) => {
      const keys = Object.keys(change).filter((key) => key.startsWith("xaxis."));
      if (busy || !keys.length || !panel.link) return;
      const wanted = Object.fromEntries(keys.map((key) => [key, change[key]]));
      for (const [other, entry] of plots) {
        if (other === element || entry.figure !== figure || entry.panel.link !== panel.link) continue;
        if (other.dataset.drawn && !other.dataset.busy) {
          other.dataset.busy = "1";
          Plotly.relayout(other, wanted).then(() => delete other.dataset.busy);
        }
      }
    });
  };

  const drawAll = async () => {
    for (const element of plots.keys()) if (visible(element)) await draw(element);
    for (const viewer of viewers) if (visible(viewer.root)) viewer.draw();
  };

  const viewers = [];

  const start = async () => {
    if (typeof DecompressionStream === "undefined") throw new Error("DecompressionStream");
    const [library, data] = await Promise.all([unpack("library"), unpack("data")]);
    const script = document.createElement("script");
    script.textContent = library;
    document.head.append(script);
    for (const [name, value] of Object.entries(JSON.parse(data))) {
      const root = document.getElementById(name);
      const kind = { patches: PatchViewer, parallel: ParallelAxes }[value.viewer];
      if (kind) {
        viewers.push(new kind(root, value.data, colours));
        continue;
      }
      const places = root.querySelectorAll(".plot");
      value.panels.forEach((panel, i) => plots.set(places[i], { panel, figure: name }));
      root.querySelectorAll(".legend button").forEach((button) => {
        button.addEventListener("click", () => toggle(name, button));
      });
    }
    for (const folded of document.querySelectorAll("details")) {
      folded.addEventListener("toggle", () => folded.open && drawAll());
    }
    await drawAll();
    const redraw = () => drawAll();
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
    matchMedia("print").addEventListener("change", redraw);
    let wait = 0;
    addEventListener("resize", () => {
      clearTimeout(wait);
      wait = setTimeout(() => viewers.forEach((viewer) => viewer.draw()), 60);
    });
  };

  const toggle = (name, button) => {
    const off = groups.get(name) || groups.set(name, new Set()).get(name);
    const group = button.dataset.group;
    const on = off.delete(group);
    if (!on) off.add(group);
    button.setAttribute("aria-pressed", String(on));
    for (const [element, entry] of plots) {
      if (entry.figure === name && element.dataset.drawn) draw(element);
    }
  };

  window.redrawn = drawAll;
  window.drawn = start().catch((error) => {
    for (const place of document.querySelectorAll(".plot, .viewer")) {
      place.textContent = "This browser is too old to draw this figure.";
      place.classList.add("missing");
    }
    if (error.message !== "DecompressionStream") throw error;
  });
})();
