// Checks of every page at every width, light and dark: nothing wider than the window, no column or word
// clipped, no overlapping texts, no short word broken, readable contrast of text.
import { setTimeout as sleep } from 'node:timers/promises';

export const kWidths = [1366, 800, 400];
export const kThemes = ['light', 'dark'];

// WCAG 2.1, success criterion 1.4.3: contrast of text against its background.
const kContrast = 4.5;

// Records the text that a page draws into canvases, because it is in no element. Runs before the page's own
// scripts.
function watchCanvases() {
  const plain = CanvasRenderingContext2D.prototype;
  const { fillText, clearRect } = plain;
  const boxes = new WeakMap();
  window.textOfCanvas = (canvas) => boxes.get(canvas) ?? [];
  const cleared = (canvas) => boxes.delete(canvas);
  for (const side of ['width', 'height']) {
    const property = Object.getOwnPropertyDescriptor(HTMLCanvasElement.prototype, side);
    Object.defineProperty(HTMLCanvasElement.prototype, side, { ...property, set(value) { cleared(this); property.set.call(this, value); } });
  }
  plain.clearRect = function (x, y, width, height) {
    if (width >= this.canvas.width / devicePixelRatio - 1) cleared(this.canvas);
    clearRect.call(this, x, y, width, height);
  };
  plain.fillText = function (text, x, y, ...more) {
    fillText.call(this, text, x, y, ...more);
    const size = this.measureText(text);
    const place = this.getTransform();
    const corners = [[-size.actualBoundingBoxLeft, -size.actualBoundingBoxAscent], [size.actualBoundingBoxRight, size.actualBoundingBoxDescent]]
      .map(([dx, dy]) => place.transformPoint({ x: x + dx, y: y + dy }));
    const [xs, ys] = [corners.map((p) => p.x / devicePixelRatio), corners.map((p) => p.y / devicePixelRatio)];
    const list = boxes.get(this.canvas) ?? [];
    list.push({ text: String(text), left: Math.min(...xs), right: Math.max(...xs), top: Math.min(...ys), bottom: Math.max(...ys), color: this.fillStyle });
    boxes.set(this.canvas, list);
  };
}

// The functions below run in the page. Each check returns a sentence per fault.

const short = (text) => text.trim().replace(/\s+/g, ' ').slice(0, 40);

function nameOf(node) {
  const classes = typeof node.className === 'string' && node.className.trim() ? `.${node.className.trim().replace(/\s+/g, '.')}` : '';
  return `${node.tagName.toLowerCase()}${node.id ? `#${node.id}` : ''}${classes}`;
}

function widerThanTheWindow() {
  const top = document.documentElement;
  if (top.scrollWidth <= top.clientWidth) return [];
  const widest = [...document.body.querySelectorAll('*')].filter((node) => node.getBoundingClientRect().right > top.clientWidth + 0.5).map(nameOf);
  return [`the page is ${top.scrollWidth - top.clientWidth} pixels wider than the window: ${[...new Set(widest)].slice(0, 4).join(', ')}`];
}

// Columns and words that need a scroll bar of their own, or cannot be seen at all. Code may scroll.
function clipped() {
  return [...document.body.querySelectorAll('*')].filter((node) => !node.closest('svg, pre, .highlight') && node.clientWidth)
    .filter((node) => getComputedStyle(node).overflowX !== 'visible' && node.scrollWidth > node.clientWidth + 1)
    .map((node) => `${nameOf(node)} hides ${node.scrollWidth - node.clientWidth} pixels of its width: ${short(node.textContent)}`);
}

// The boxes of a text's lines, clipped by containers that scroll.
function boxesOf(node, holder) {
  const range = document.createRange();
  range.selectNodeContents(node);
  let boxes = [...range.getClientRects()].filter((box) => box.width > 0.5 && box.height > 0.5);
  for (let outer = holder; outer && outer !== document.body; outer = outer.parentElement) {
    if (outer instanceof SVGElement || getComputedStyle(outer).overflowY === 'visible') continue;
    const frame = outer.getBoundingClientRect();
    boxes = boxes.map(({ left, right, width, top, bottom }) => ({ left, right, width, top: Math.max(top, frame.top), bottom: Math.min(bottom, frame.bottom) }))
      .map((box) => ({ ...box, height: box.bottom - box.top })).filter((box) => box.height > 1);
  }
  return boxes;
}

function textsOfThePage() {
  const texts = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const holder = node.parentElement;
    if (!node.data.trim() || holder.closest('script, style, noscript, option, title')) continue;
    if (!holder.checkVisibility({ opacityProperty: true, visibilityProperty: true })) continue;
    const boxes = boxesOf(node, holder);
    if (boxes.length) texts.push({ node, holder, boxes, text: short(node.data) });
  }
  return texts;
}

// Every line of every text, and the text of canvases. Line boxes are higher than letters, so neighbours may
// overlap by a few pixels.
function piecesOf(texts) {
  const pieces = texts.flatMap((text) => text.boxes.map((box) => {
    const slack = text.holder instanceof SVGElement ? 0.12 : 0.18;
    return { text, left: box.left + 0.5, right: box.right - 0.5, top: box.top + slack * box.height, bottom: box.bottom - slack * box.height };
  }));
  for (const canvas of document.querySelectorAll('canvas')) {
    if (!canvas.clientWidth || !canvas.checkVisibility()) continue;
    const frame = canvas.getBoundingClientRect();
    for (const drawn of window.textOfCanvas?.(canvas) ?? []) {
      if (!drawn.text.trim() || drawn.right < 0 || drawn.left > frame.width) continue;
      pieces.push({
        text: { node: drawn, holder: canvas, text: drawn.text, ink: drawn.color },
        left: frame.left + drawn.left, right: frame.left + drawn.right, top: frame.top + drawn.top, bottom: frame.top + drawn.bottom,
      });
    }
  }
  return pieces.sort((a, b) => a.top - b.top);
}

function overlapping(pieces) {
  const faults = [];
  // A sticky element covers content that is scrolled below it.
  const stays = (piece) => {
    for (let outer = piece.text.holder; outer; outer = outer.parentElement) if (/sticky|fixed/.test(getComputedStyle(outer).position)) return true;
    return false;
  };
  pieces.forEach((a, i) => {
    for (let j = i + 1; j < pieces.length && pieces[j].top < a.bottom; ++j) {
      const b = pieces[j];
      if (a.text.node === b.text.node || a.right <= b.left || b.right <= a.left || stays(a) !== stays(b)) continue;
      faults.push(`'${a.text.text}' and '${b.text.text}' overlap`);
    }
  });
  return faults;
}

// A legend must be beside its figure, not on it.
function legendsOnFigures() {
  const faults = [];
  for (const legend of document.querySelectorAll('.legend')) {
    const box = legend.getBoundingClientRect();
    for (const drawing of legend.closest('figure')?.querySelectorAll('svg, canvas') ?? []) {
      if (drawing.parentElement instanceof SVGElement) continue;
      const frame = drawing.getBoundingClientRect();
      const apart = box.bottom <= frame.top + 2 || box.top >= frame.bottom || box.right <= frame.left || box.left >= frame.right;
      if (box.height && frame.height && !apart) faults.push(`a legend stands on its figure: ${short(legend.textContent)}`);
    }
  }
  return faults;
}

// The name of a card's line is generated content, so it is in no text node: it must not run into its value.
function namesOnValues() {
  const pen = document.createElement('canvas').getContext('2d');
  return [...document.querySelectorAll('[data-form=cards] td[data-name]')].filter((cell) => {
    const name = getComputedStyle(cell, '::before');
    if (!cell.clientWidth || name.content === 'none' || name.whiteSpace !== 'nowrap') return false;
    pen.font = name.font;
    return pen.measureText(cell.dataset.name).width > parseFloat(name.width);
  }).map((cell) => `the name '${cell.dataset.name}' runs into its value '${short(cell.textContent)}'`);
}

function outsideOfFigureOrWindow(texts, pieces) {
  const faults = [];
  for (const { holder, boxes, text } of texts) {
    const figure = holder instanceof SVGElement && holder.closest('svg');
    if (!figure) continue;
    const frame = figure.getBoundingClientRect();
    const inside = (box) => box.left >= frame.left - 1 && box.right <= frame.right + 1 && box.top >= frame.top - 1 && box.bottom <= frame.bottom + 1;
    if (!boxes.every(inside)) faults.push(`'${text}' reaches out of its figure`);
  }
  const width = document.documentElement.clientWidth;
  for (const piece of pieces) {
    if (piece.right <= 0 || piece.text.holder.closest('pre')) continue;  // hidden on purpose, or code
    if (piece.left < -1 || piece.right > width + 1) faults.push(`'${piece.text.text}' reaches out of the window`);
  }
  return faults;
}

// Short words broken into two lines. Paths and identifiers longer than a phone's column may break.
function brokenWords(texts) {
  const faults = [];
  for (const { node, holder, text } of texts) {
    if (holder instanceof SVGElement || holder.closest('pre, code')) continue;
    for (const word of node.data.matchAll(/[A-Za-zÄÖÜäöüß0-9.]{2,14}/g)) {
      const end = word.index + word[0].length;
      if (/[\w/\\]/.test((node.data[word.index - 1] ?? ' ') + (node.data[end] ?? ' '))) continue;
      const range = document.createRange();
      range.setStart(node, word.index);
      range.setEnd(node, end);
      const lines = new Set([...range.getClientRects()].filter((box) => box.width > 0.5).map((box) => Math.round(box.top / 4)));
      if (lines.size > 1) faults.push(`'${word[0]}' is broken over ${lines.size} lines in '${text}'`);
    }
  }
  return faults;
}

// A colour of the style sheet as red, green, blue and opacity.
function colorReader() {
  const pen = document.createElement('canvas').getContext('2d', { willReadFrequently: true });
  const known = new Map();
  return (text) => {
    if (!known.has(text)) {
      pen.canvas.width = pen.canvas.height = 1;
      pen.fillStyle = text;
      pen.fillRect(0, 0, 1, 1);
      const [r, g, b, a] = pen.getImageData(0, 0, 1, 1).data;
      known.set(text, [r, g, b, a / 255]);
    }
    return known.get(text);
  };
}

const blend = (over, under) => over.slice(0, 3).map((v, i) => v * over[3] + under[i] * (1 - over[3])).concat(1);

// The background colour of an element, and the opacity of its text.
function paperOf(node, colorOf) {
  const papers = [];
  let fade = 1;
  for (let outer = node; outer; outer = outer.parentElement) {
    const style = getComputedStyle(outer);
    fade *= outer instanceof SVGElement ? 1 : Number(style.opacity);
    const paper = colorOf(style.backgroundColor);
    if (paper[3] > 0) papers.push(paper);
    // A gradient has several colours; the strongest counts.
    const stops = [...style.backgroundImage.matchAll(/(?:rgba?|color)\([^()]*\)/g)].map(([shade]) => colorOf(shade));
    if (stops.length) papers.push(stops.reduce((a, b) => (b[3] > a[3] ? b : a)));
  }
  return { paper: papers.reverse().reduce((under, over) => blend(over, under), [255, 255, 255, 1]), fade };
}

function light(color) {
  const linear = color.slice(0, 3).map((v) => v / 255).map((v) => (v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
  return linear.reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
}

function tooPale(texts, pieces, least) {
  const colorOf = colorReader();
  const drawn = pieces.map((piece) => piece.text).filter((text) => text.ink);
  return [...texts, ...drawn].flatMap(({ holder, text, ink }) => {
    const { paper, fade } = paperOf(holder, colorOf);
    const [r, g, b, a] = colorOf(ink ?? getComputedStyle(holder)[holder instanceof SVGElement ? 'fill' : 'color']);
    const lights = [light(blend([r, g, b, a * fade], paper)), light(paper)];
    const contrast = (Math.max(...lights) + 0.05) / (Math.min(...lights) + 0.05);
    return contrast < least ? [`'${text}' has a contrast of ${contrast.toFixed(1)} (${nameOf(holder)})`] : [];
  });
}

const kInThePage = `${[short, blend].map((made) => `const ${made.name} = ${made};`).join('\n')}
${[nameOf, widerThanTheWindow, clipped, boxesOf, textsOfThePage, piecesOf, overlapping, namesOnValues, legendsOnFigures, outsideOfFigureOrWindow, brokenWords,
  colorReader, paperOf, light, tooPale].join('\n')}`;

const kFaults = `(least) => {
  ${kInThePage}
  const texts = textsOfThePage();
  const pieces = piecesOf(texts);
  return [...new Set([...widerThanTheWindow(), ...clipped(), ...overlapping(pieces), ...namesOnValues(), ...legendsOnFigures(), ...outsideOfFigureOrWindow(texts, pieces),
    ...brokenWords(texts), ...tooPale(texts, pieces, least)])];
}`;

// Opens a page at a width in a theme with everything unfolded, at full height; returns its faults.
export class Layout {
  static async of(browser) {
    const layout = new Layout();
    layout.browser = browser;
    await layout.cdp('Page.addScriptToEvaluateOnNewDocument', { source: `(${watchCanvases})()` });
    return layout;
  }

  cdp(cmd, params = {}) {
    return this.browser.call('POST', `${this.browser.session}/goog/cdp/execute`, { cmd, params });
  }

  size(width, height) {
    return this.cdp('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: false });
  }

  async open(file, width, theme) {
    await this.cdp('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: theme }] });
    await this.size(width, 800);
    await this.browser.open(file);
    await this.browser.run(() => document.querySelectorAll('details').forEach((details) => { details.open = true; }));
    await sleep(200);
    const height = await this.browser.run(() => document.documentElement.scrollHeight);
    await this.size(width, Math.min(height + 50, 16000));
    await sleep(200);
  }

  faults() {
    return this.browser.run(kFaults, kContrast);
  }

  // Faults of a page at every width in both themes, each with the widths and themes in which it occurs.
  async everywhere(file) {
    const found = new Map();
    for (const width of kWidths)
      for (const theme of kThemes) {
        for (const fault of await this.at(file, width, theme)) found.set(fault, [...(found.get(fault) ?? []), `${width} ${theme}`]);
      }
    return [...found].map(([fault, places]) => `${fault} [${places.join(', ')}]`);
  }

  async at(file, width, theme) {
    await this.open(file, width, theme);
    const found = await this.faults();
    await this.end();
    return found;
  }

  async end() {
    await this.cdp('Emulation.clearDeviceMetricsOverride');
    await this.cdp('Emulation.setEmulatedMedia', { features: [] });
  }
}
