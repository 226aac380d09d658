// A named colour, mixed with the page's background by `shade`.
function colorOf({ color, shade }) {
  return shade ? `color-mix(in srgb, var(--${color}) ${Math.round(100 - 62 * shade)}%, var(--sheet))` : `var(--${color})`;
}

// Names above a plot. A click hides or shows a line. At the pointer's time each name shows the line's value.
class Legend {
  // entries: [{ label, color, style, shown }]; a label is text or a list of texts and elements
  constructor(container, entries, onToggle, withValues = true) {
    this.values = entries.map(() => (withValues ? element('span', { className: 'value' }) : ''));
    this.buttons = entries.map((entry, i) => {
      const swatch = element('i', { className: entry.style || 'line' });
      swatch.style.color = colorOf(entry);
      if (!entry.style?.startsWith('points') && entry.style !== 'band') swatch.style.borderTopColor = colorOf(entry);
      const button = element('button', { type: 'button' }, swatch, ...[entry.label].flat(), this.values[i]);
      button.setAttribute('aria-pressed', String(entry.shown));
      button.onclick = () => {
        entry.shown = !entry.shown;
        button.setAttribute('aria-pressed', String(entry.shown));
        onToggle(i, entry.shown);
      };
      return button;
    });
    container.append(element('div', { className: 'legend' }, ...this.buttons));
  }

  show(values, digits) {
    this.values.forEach((span, i) => {
      const value = values ? values[i] : null;
      span.textContent = value === null || value === undefined || Number.isNaN(value) ? '' : value.toFixed(digits);
    });
  }
}
