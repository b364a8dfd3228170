// What is wrong with how a page looks now: texts over texts, texts that are cut off or too faint,
// and what is wider than the page. Gives a list of sentences.
(() => {
  const found = [];
  const root = document.documentElement;
  if (root.scrollWidth > root.clientWidth + 1) {
    const wide = [...document.body.querySelectorAll("*")].find((e) =>
      e.getBoundingClientRect().right > root.clientWidth + 1 && !e.closest("svg"));
    found.push(`wider than the page: ${root.scrollWidth} px of ${root.clientWidth}, ` +
      `${wide ? `${wide.tagName} ${wide.className}` : ""}`);
  }

  const seen = (element) => {
    const style = getComputedStyle(element);
    return style.visibility !== "hidden" && style.display !== "none" && +style.opacity > 0.05;
  };
  const texts = [];
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walk.nextNode(); node; node = walk.nextNode()) {
    const text = node.textContent.trim();
    const parent = node.parentElement;
    if (!text || parent.closest("script, style, .modebar, option")) continue;
    if (parent.closest("details:not([open])") && !parent.closest("summary")) continue;
    if (!seen(parent)) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    for (const box of range.getClientRects()) {
      if (box.width > 1 && box.height > 1) texts.push({ text, box, parent });
    }
  }
  if (!texts.length) found.push("no text is seen");

  texts.sort((a, b) => a.box.top - b.box.top);
  for (let i = 0; i < texts.length; i += 1) {
    const a = texts[i];
    for (let j = i + 1; j < texts.length && texts[j].box.top < a.box.bottom; j += 1) {
      const b = texts[j];
      // parts of one sentence, and what scrolls beside it, may touch
      if (a.parent.closest("p, text, button, dd") && a.parent.closest("p, text, button, dd") ===
        b.parent.closest("p, text, button, dd")) continue;
      const wide = Math.min(a.box.right, b.box.right) - Math.max(a.box.left, b.box.left);
      const high = Math.min(a.box.bottom, b.box.bottom) - Math.max(a.box.top, b.box.top);
      if (wide > 2 && high > 4) found.push(`"${a.text}" and "${b.text}" lie over each other`);
    }
  }

  const parse = (colour) => {
    const parts = colour.match(/[\d.]+/g).map(Number);
    return [parts[0], parts[1], parts[2], parts.length > 3 ? parts[3] : 1];
  };
  const luminance = (rgb) => {
    const [r, g, b] = rgb.slice(0, 3).map((c) => {
      const v = c / 255;
      return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const groundOf = (element) => {
    for (let e = element; e; e = e.parentElement) {
      const colour = parse(getComputedStyle(e).backgroundColor);
      if (colour[3] > 0.5) return colour;
    }
    return parse(getComputedStyle(root).colorScheme.includes("dark") ? "rgb(0,0,0)" : "rgb(255,255,255)");
  };
  for (const cell of document.querySelectorAll("td")) {
    const box = cell.getBoundingClientRect();
    const line = parseFloat(getComputedStyle(cell).fontSize) * 1.5;
    if (!matchMedia("print").matches && box.width < 110 && box.height > 5 * line) {
      const own = cell.textContent.trim();
      if (own.length > 30) found.push(`"${own}" stands in ${box.width.toFixed(0)} px`);
    }
  }

  const faint = new Set();
  for (const { text, parent } of texts) {
    const svg = parent.closest("text");
    const style = getComputedStyle(svg || parent);
    const ink = parse(svg ? style.fill : style.color);
    const levels = [luminance(ink), luminance(groundOf(svg ? svg.closest(".plot, figure") : parent))];
    const contrast = (Math.max(...levels) + 0.05) / (Math.min(...levels) + 0.05);
    if (contrast < 4.5) faint.add(`"${text}": contrast ${contrast.toFixed(2)} of 4.5`);
  }
  found.push(...faint);

  for (const place of document.querySelectorAll(".plot")) {
    const hidden = place.closest("details:not([open])");
    if (!hidden && !place.querySelector("svg")) found.push(`a figure is not drawn: ${place.closest("figure").id}`);
  }
  for (const canvas of document.querySelectorAll("canvas")) {
    if (canvas.closest("details:not([open])")) continue;
    const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    const colours = new Set();
    for (let i = 0; i < pixels.length && colours.size < 20; i += 4 * 97) {
      colours.add(pixels.slice(i, i + 4).join());
    }
    if (colours.size < 4) found.push(`a canvas is empty: ${canvas.getAttribute("aria-label")}`);
  }
  return found;
})()
