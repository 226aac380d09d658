// Colours come from the style sheet. Canvases read them here and are redrawn when the theme or the medium
// changes.
const theme = {
  choices: ['auto', 'light', 'dark'],
  choice: 'auto',
  system: matchMedia('(prefers-color-scheme: dark)'),
  redraw: [],
  palette: null,

  start(button) {
    button.onclick = () => {
      this.choice = this.choices[(this.choices.indexOf(this.choice) + 1) % this.choices.length];
      this.apply(button);
    };
    this.system.onchange = () => this.apply(button);
    this.apply(button);
    // Printed pages are white and have their own width.
    addEventListener('beforeprint', () => {
      document.documentElement.classList.add('printing');
      this.show('light');
    });
    addEventListener('afterprint', () => {
      document.documentElement.classList.remove('printing');
      this.apply(button);
    });
  },

  apply(button) {
    button.textContent = `Theme: ${this.choice}`;
    this.show(this.choice === 'auto' ? (this.system.matches ? 'dark' : 'light') : this.choice);
  },

  show(name) {
    document.documentElement.dataset.theme = name;
    this.palette = getComputedStyle(document.documentElement);
    for (const draw of this.redraw) draw();
  },

  color(name) {
    return this.palette.getPropertyValue(`--${name}`).trim();
  },
};
