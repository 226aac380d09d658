// Menu on a phone, light and dark theme, tables on a small screen, and the search. The search index is a
// script, because a page that is opened from a folder may not read other files. It is loaded at the first
// search.
'use strict';
const byId = (id) => document.getElementById(id);

// Long names in a table may break at suitable characters.
for (const code of document.querySelectorAll('main td code'))
  code.replaceChildren(...code.textContent.split(/(?<=[_./])/).flatMap((part) => [part, document.createElement('wbr')]));

// Tables that are too wide for the page become cards: see fitted_table.js.
for (const table of document.querySelectorAll('main table')) {
  const box = document.createElement('div');
  box.className = 'table';
  table.replaceWith(box);
  box.append(table);
  fitTable(box);
}

const menuButton = byId('menu-button');
function showMenu(open) {
  document.body.classList.toggle('menu-open', open);
  menuButton.setAttribute('aria-expanded', open);
}
menuButton.addEventListener('click', () => showMenu(menuButton.getAttribute('aria-expanded') !== 'true'));
byId('menu').addEventListener('click', (event) => event.target.closest('a') && showMenu(false));
const here = document.querySelector('#menu .here');
if (here) byId('menu').scrollTop = here.offsetTop - 200;

const themeButton = byId('theme-button');
const systemIsDark = matchMedia('(prefers-color-scheme: dark)');
const isDark = () => (document.documentElement.dataset.theme || (systemIsDark.matches ? 'dark' : 'light')) === 'dark';
const nameTheme = () => { themeButton.textContent = isDark() ? 'Light' : 'Dark'; };
themeButton.addEventListener('click', () => {
  const chosen = isDark() ? 'light' : 'dark';
  document.documentElement.dataset.theme = chosen;
  try { localStorage.setItem('theme', chosen); } catch { /* storage is off: holds for this page */ }
  nameTheme();
});
systemIsDark.addEventListener('change', nameTheme);
nameTheme();

// Search: finds sections that contain every word, also as the beginning of a longer word or with one wrong
// letter.
const words = byId('search-words');
const results = byId('search-results');
const kMostResults = 20;
let index;
let sections;

function load(file) {
  return new Promise((resolve, reject) => {
    const script = document.createElement('script');
    script.src = `${siteRoot}/search/${file}`;
    script.onload = resolve;
    script.onerror = () => reject(new Error(`${file} is missing beside the pages: build them again`));
    document.head.append(script);
  });
}

let loading;
function loadIndex() {
  loading ??= Promise.all([load('lunr.js'), load('search_index.js')]).then(() => {
    sections = new Map(searchIndex.docs.map((section) => [section.location, section]));
    lunr.tokenizer.separator = /[\s\-_.,;:()[\]{}<>"'`=|/\\]+/;
    index = lunr(function build() {
      this.ref('location');
      this.field('title', { boost: 10 });
      this.field('text');
      for (const section of searchIndex.docs) this.add(section);
    });
  });
  return loading;
}

function scoresOf(word) {
  const found = index.query((query) => {
    query.term(word, { boost: 10 });
    query.term(word, { usePipeline: false, boost: 3, wildcard: lunr.Query.wildcard.TRAILING });
    if (word.length > 4) query.term(word, { editDistance: 1 });
  });
  return new Map(found.map(({ ref, score }) => [ref, score]));
}

function search(text) {
  const asked = lunr.tokenizer(text).map(String).filter((word) => word.length > 1);
  if (asked.length === 0) return [];
  // The index leaves out words that occur in every text ("the", "off").
  const scores = asked.filter((word) => lunr.stopWordFilter(word)).map(scoresOf);
  if (scores.length === 0) return [];
  const phrase = text.trim();
  const holds = (part) => part.toLowerCase().includes(phrase);
  // Words in the order in which they were typed, in a heading or in the text, rank higher than the same words
  // apart.
  const asTyped = ({ title, text: body }) => (holds(title) ? 100 : 0) + (holds(body) ? 10 : 0);
  const total = (ref) => scores.reduce((sum, map) => sum + map.get(ref), asTyped(sections.get(ref)));
  const all = [...scores[0].keys()].filter((ref) => scores.every((map) => map.has(ref)));
  return all.sort((a, b) => total(b) - total(a)).slice(0, kMostResults).map((ref) => ({ section: sections.get(ref), asked }));
}

// The text around the first hit, with every hit marked; made of nodes, so that no text is parsed as markup.
function excerpt(text, asked) {
  const escaped = asked.map((word) => word.replace(/[.*+?^${}()|[\]\\]/g, '\\$&'));
  const hit = new RegExp(`(${escaped.join('|')})`, 'gi');
  const plain = new DOMParser().parseFromString(text, 'text/html').body.textContent.replace(/\s+/g, ' ');
  const from = plain.lastIndexOf(' ', Math.max(0, plain.search(hit) - 60)) + 1;
  return plain.slice(from, from + 170).split(hit).map((part, i) => {
    if (i % 2 === 0) return part;
    const mark = document.createElement('mark');
    mark.textContent = part;
    return mark;
  });
}

function titleOfPage(location) {
  const page = sections.get(location.split('#')[0]);
  return page ? page.title : '';
}

function entry({ section, asked }) {
  const link = document.createElement('a');
  link.href = `${siteRoot}/${section.location}`;
  link.setAttribute('role', 'option');
  const title = document.createElement('b');
  title.textContent = section.title;
  const place = document.createElement('small');
  const page = titleOfPage(section.location);
  place.textContent = page === section.title ? '' : page;
  const text = document.createElement('span');
  text.append(...excerpt(section.text, asked));
  link.append(title, place, text);
  return link;
}

function say(text) {
  const line = document.createElement('p');
  line.textContent = text;
  results.replaceChildren(line);
}

let asking = 0;
async function showResults() {
  const text = words.value.trim();
  const mine = ++asking;
  results.hidden = text.length < 2;
  if (results.hidden) return;
  try {
    await loadIndex();
  } catch (error) {
    return say(error.message);
  }
  if (mine !== asking) return;
  const found = search(text.toLowerCase());
  if (found.length === 0) say(`Nothing found for “${text}”.`);
  else results.replaceChildren(...found.map(entry));
}

function choose(step) {
  const links = [...results.querySelectorAll('a')];
  if (links.length === 0) return;
  const now = links.findIndex((link) => link.getAttribute('aria-selected') === 'true');
  links[now]?.removeAttribute('aria-selected');
  const next = links[(now + step + links.length) % links.length];
  next.setAttribute('aria-selected', 'true');
  next.scrollIntoView({ block: 'nearest' });
}

words.addEventListener('focus', () => { loadIndex().catch(() => {}); if (words.value) showResults(); });
words.addEventListener('input', showResults);
words.addEventListener('keydown', (event) => {
  if (event.key === 'ArrowDown' || event.key === 'ArrowUp') {
    event.preventDefault();
    choose(event.key === 'ArrowDown' ? 1 : -1);
  }
});
byId('search').addEventListener('submit', (event) => {
  event.preventDefault();
  (results.querySelector('[aria-selected="true"]') || results.querySelector('a'))?.click();
});
document.addEventListener('click', (event) => { if (!byId('search').contains(event.target)) results.hidden = true; });
document.addEventListener('keydown', (event) => {
  if (event.key === 'Escape') {
    results.hidden = true;
    showMenu(false);
  } else if (event.key === '/' && document.activeElement === document.body) {
    event.preventDefault();
    words.focus();
  }
});
