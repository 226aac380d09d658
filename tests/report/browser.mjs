// Controls headless Chromium by chromedriver's WebDriver protocol; needs only Node and Debian's packages.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const kQuiet = [
  '--headless=new', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-sync',
  '--disable-background-networking', '--disable-component-update', '--hide-scrollbars', '--disable-dev-shm-usage',
];

export class Browser {
  static async start(size) {
    const browser = new Browser();
    browser.profile = mkdtempSync(join(tmpdir(), 'sandhopper-browser-'));
    browser.driver = spawn('chromedriver', ['--port=0'], { stdio: ['ignore', 'pipe', 'inherit'] });
    try {
      await browser.connect(size);
    } catch (error) {
      browser.end();
      throw error;
    }
    return browser;
  }

  async connect({ width, height }) {
    this.url = await new Promise((resolve, reject) => {
      this.driver.on('error', error => {
        if (error.code !== 'ENOENT') return reject(error);
        console.log('skipped: no chromedriver here (Ubuntu has no Debian package of Chromium)');
        rmSync(this.profile, { recursive: true, force: true });
        process.exit(77);
      });
      this.driver.stdout.on('data', text => {
        const port = /successfully on port (\d+)/.exec(text);
        if (port) resolve(`http://127.0.0.1:${port[1]}`);
      });
    });
    const args = [...kQuiet, `--window-size=${width},${height}`, `--user-data-dir=${this.profile}`];
    const session = await this.call('POST', '/session', {
      capabilities: {
        alwaysMatch: {
          browserName: 'chrome',
          'goog:chromeOptions': { args },
          'goog:loggingPrefs': { browser: 'ALL', performance: 'ALL' },
        },
      },
    });
    this.session = `/session/${session.sessionId}`;
  }

  async call(method, path, body) {
    const options = { method, headers: { 'Content-Type': 'application/json' } };
    if (method === 'POST') options.body = JSON.stringify(body || {});
    const answer = await (await fetch(this.url + path, options)).json();
    if (answer.value && answer.value.error) throw new Error(`${path}: ${answer.value.message}`);
    return answer.value;
  }

  async open(file) {
    await this.complaints();  // discards complaints of the previous page
    return this.call('POST', `${this.session}/url`, { url: `file://${file}` });
  }

  // Runs a function in the page and returns its result.
  run(script, ...args) {
    return this.call('POST', `${this.session}/execute/sync`, { script: `return (${script}).apply(null, arguments)`, args });
  }

  // Presses the mouse at one point of the window, moves and releases it at another.
  drag([x0, y0], [x1, y1]) {
    const move = (x, y, duration) => ({ type: 'pointerMove', x: Math.round(x), y: Math.round(y), duration });
    return this.act([
      move(x0, y0, 0), { type: 'pointerDown', button: 0 },
      move((x0 + x1) / 2, (y0 + y1) / 2, 60), move(x1, y1, 60), { type: 'pointerUp', button: 0 },
    ]);
  }

  point(x, y) {
    return this.act([{ type: 'pointerMove', x: Math.round(x), y: Math.round(y), duration: 0 }]);
  }

  doubleClick(x, y) {
    const press = [{ type: 'pointerDown', button: 0 }, { type: 'pointerUp', button: 0 }];
    return this.act([{ type: 'pointerMove', x: Math.round(x), y: Math.round(y), duration: 0 }, ...press, ...press]);
  }

  act(actions) {
    return this.call('POST', `${this.session}/actions`, {
      actions: [{ type: 'pointer', id: 'mouse', parameters: { pointerType: 'mouse' }, actions }],
    });
  }

  resize(width, height) {
    return this.call('POST', `${this.session}/window/rect`, { width, height });
  }

  async screenshot(file) {
    writeFileSync(file, Buffer.from(await this.call('GET', `${this.session}/screenshot`), 'base64'));
  }

  async print(file) {
    const pdf = await this.call('POST', `${this.session}/print`, { page: { width: 21, height: 29.7 }, background: true });
    writeFileSync(file, Buffer.from(pdf, 'base64'));
  }

  // Console messages of the page, and every address that it requested besides its own file, since the last
  // call.
  async complaints() {
    // dygraphs 2.2 (Debian 13) reports the number of points outside a zoomed plot.
    const of_zoomed_plot = /"\d+ points out of [XY] bounds:/;
    const lines = (await this.call('POST', `${this.session}/se/log`, { type: 'browser' }))
      .map(entry => entry.message).filter(message => !of_zoomed_plot.test(message));
    for (const entry of await this.call('POST', `${this.session}/se/log`, { type: 'performance' })) {
      const { method, params } = JSON.parse(entry.message).message;
      if (method !== 'Network.requestWillBeSent') continue;
      if (!params.documentURL.startsWith('file:')) continue; // the browser's own pages
      if (!/^(file|data):/.test(params.request.url)) lines.push(`asked for ${params.request.url}`);
    }
    return lines;
  }

  async stop() {
    try {
      await this.call('DELETE', this.session);
    } finally {
      this.end();
    }
  }

  end() {
    this.driver.kill();
    rmSync(this.profile, { recursive: true, force: true });
  }
}
