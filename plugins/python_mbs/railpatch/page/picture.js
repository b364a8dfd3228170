"use strict";
// One figure of a page by itself: its place for a picture, or all of it as SVG.
(() => {
  const settle = () => new Promise((ready) => setTimeout(ready, 150));

  // hides the rest of the page; gives the figure's x, y, width and height
  window.figureAlone = async (name) => {
    const figure = document.getElementById(name);
    for (let e = figure; e && e !== document.body; e = e.parentElement) {
      if (e.tagName === "DETAILS") e.open = true;
      for (const other of e.parentElement.children) {
        // by the tester plotly measures texts: hidden, titles and labels had no size
        const kept = ["SCRIPT", "STYLE"].includes(other.tagName) || other.id === "js-plotly-tester";
        if (other !== e && !kept) other.style.display = "none";
      }
    }
    for (const spare of figure.querySelectorAll(".controls input, .controls label, .hint")) {
      spare.style.display = "none";
    }
    document.body.style.padding = "12px";
    document.body.style.maxWidth = "none";
    await settle();
    await redrawn();
    await settle();
    const box = figure.getBoundingClientRect();
    return [box.left + scrollX - 8, box.top + scrollY - 8, box.width + 16, box.height + 16];
  };

  const escaped = (text) => text.replace(/[&<>]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;" }[c]));

  // text of an element with its subscripts, as tspans
  const spans = (element) => [...element.childNodes].map((node) => {
    if (node.nodeType === Node.TEXT_NODE) return escaped(node.textContent);
    const down = { SUB: 4, SUP: -5 }[node.tagName];
    if (!down) return spans(node);
    return `<tspan dy="${down}" font-size="75%">${spans(node)}</tspan><tspan dy="${-down}">\u200b</tspan>`;
  }).join("");

  window.figureAsSvg = async (name) => {
    const [left, top, width, height] = await figureAlone(name);
    const figure = document.getElementById(name);
    const style = getComputedStyle(document.documentElement);
    const ink = (which) => style.getPropertyValue(`--${which}`).trim();
    const place = (element) => {
      const box = element.getBoundingClientRect();
      return [box.left + scrollX - left, box.top + scrollY - top, box.width, box.height];
    };
    const parts = [];
    for (const button of figure.querySelectorAll(".legend button")) {
      const sample = button.querySelector("svg");
      const [x, y] = place(sample);
      parts.push(`<g transform="translate(${x} ${y})">${sample.innerHTML}</g>`);
      const [tx, ty, , th] = place(button.querySelector("span"));
      parts.push(`<text x="${tx}" y="${ty + 0.75 * th}" font-size="13.5" fill="${ink("ink")}">` +
        `${spans(button.querySelector("span"))}</text>`);
    }
    for (const title of figure.querySelectorAll(".panel-title")) {
      const [x, y, , h] = place(title);
      parts.push(`<text x="${x}" y="${y + 0.75 * Math.min(h, 20)}" font-size="13.5" ` +
        `fill="${ink("soft")}">${spans(title)}</text>`);
    }
    for (const plot of figure.querySelectorAll(".plot")) {
      const [x, y] = place(plot);
      // layers that lie over each other, as they are on the page
      for (const layer of plot.querySelectorAll("svg.main-svg")) {
        const copy = layer.cloneNode(true);
        copy.setAttribute("x", x);
        copy.setAttribute("y", y);
        copy.removeAttribute("style");
        parts.push(new XMLSerializer().serializeToString(copy));
      }
    }
    return `<svg xmlns="http://www.w3.org/2000/svg" width="${Math.ceil(width)}" ` +
      `height="${Math.ceil(height)}" font-family="system-ui, sans-serif">` +
      `<rect width="100%" height="100%" fill="${ink("ground")}"/>${parts.join("")}</svg>\n`;
  };
})();
