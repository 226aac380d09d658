// Data of the page: numbers as typed arrays, NaN in rows without a value.
function readData() {
  const data = JSON.parse(document.getElementById('data').textContent);
  data.time = new Float64Array(bytesOf(data.time_s).buffer);
  for (const name of Object.keys(data.columns)) {
    data.columns[name] = new Float32Array(bytesOf(data.columns[name]).buffer);
  }
  return data;
}

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

// Index of the first row at or after a time.
function rowAt(time, instant) {
  let low = 0;
  let high = time.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (time[middle] < instant) low = middle + 1;
    else high = middle;
  }
  return low;
}

// Makes an element: element('td', { className: 'text' }, 'content', childElement, …).
function element(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

// Words between backquotes are commands or keys.
function withCode(text) {
  return text.split('`').map((part, i) => (i % 2 ? element('code', {}, part) : part));
}
