// The constants that no unit test holds: each named constant of some files times 0.5 and times 2.
//   node tests/limits/mutate_limits.mjs write FILE…          changes the FILEs and lists their constants
//   node tests/limits/mutate_limits.mjs run UNIT_TESTS FILE… runs the quick tests once for each change
// Only in a copy of the tree: `write` replaces `constexpr T kName = VALUE` by a value that the environment
// changes, so that one build serves all changes. Then build unit_tests there; `run` needs no other build.
// SUITES: regular expression of the tests (default ^Diagnose). A test is quick below SECONDS (default 0.3).
// Constants that the compiler needs (sizes of arrays, options of a fit) and numbers without a name stay.
import { execFileSync, spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';

const suites = new RegExp(process.env.SUITES ?? '^Diagnose');
const quick_ms = 1e3 * Number(process.env.SECONDS ?? 0.3);
const kCompiled = new Set(['kOrder', 'kFormKnots', 'kKnots', 'kLawKnots', 'kFineKnots', 'kNoCandidate', 'kBins',
  'kNone', 'kAnySize', 'kStepsBeside', 'kBeside', 'kApart', 'kParts', 'kEverywhere_m']);
const kTypes = 'double|int|std::size_t|std::ptrdiff_t|std::uint32_t|std::uint64_t|Index|Eigen::Index';
const kDeclaration = new RegExp(`^(\\s*)(inline |static )?constexpr (${kTypes}) (k[A-Z][^;{}]*?);`, 'gms');

// Parts of a list of declarators, split at commas outside brackets.
function declarators(list) {
  const parts = [''];
  let depth = 0;
  for (const c of list) {
    if ('([<'.includes(c)) ++depth;
    if (')]>'.includes(c)) --depth;
    if (c === ',' && depth === 0) parts.push('');
    else parts[parts.length - 1] += c;
  }
  return parts.map((part) => part.trim());
}

function write(file) {
  const text = fs.readFileSync(file, 'utf8');
  const names = [];  // "search.cpp:kFreed"; of several with one name the others are "…#2", "…#3"
  const key = (name) => {
    const first = `${path.basename(file)}:${name}`;
    const before = names.filter((known) => known.replace(/#\d+$/, '') === first).length;
    names.push(before === 0 ? first : `${first}#${before + 1}`);
    return names.at(-1);
  };
  let changed = text.replace(kDeclaration, (all, indent, storage, type, list) => {
    const parts = declarators(list).map((part) => part.match(/^(k\w+)\s*=\s*([\s\S]+)$/));
    if (parts.some((part) => part === null || kCompiled.has(part[1]))) return all;
    const values = parts.map(
      ([, name, value]) => `${name} = ::sandhopper::mutated<${type}>("${key(name)}", ${value})`);
    return `${indent}${storage === 'inline ' ? 'inline' : 'static'} const ${type} ${values.join(', ')};`;
  });
  if (file.endsWith('limits.hpp') && text.includes('struct Limits {')) {
    changed = changed.replace(/^  double (\w+) = ([\d.]+);/gm, (all, name, value) =>
      `  double ${name} = ::sandhopper::mutated<double>("${key(name)}", ${value});`).replace('inline constexpr Limits', 'inline const Limits');
  }
  if (names.length === 0) return;
  const include = '#include "tests/limits/mutated.hpp"\n';
  changed = changed.startsWith('#pragma once\n') ? changed.replace('#pragma once\n', `#pragma once\n${include}`)
                                                 : include + changed;
  fs.writeFileSync(file, changed);
  for (const name of names) console.log(name);
}

function written(file) {
  return [...fs.readFileSync(file, 'utf8').matchAll(/mutated<[\w:]+>\("([^"]+)"/g)].map((match) => match[1]);
}

// Names of the quick tests, from one run without a change.
function quick_tests(program) {
  const list = execFileSync(program, ['--gtest_list_tests'], { encoding: 'utf8' });
  const wanted = [...list.matchAll(/^(\w+)\./gm)].map((match) => match[1]).filter((suite) => suites.test(suite));
  const { stdout } = spawnSync(program, [`--gtest_filter=${wanted.map((suite) => `${suite}.*`).join(':')}`],
    { encoding: 'utf8', maxBuffer: 1 << 28 });
  return [...stdout.matchAll(/^\[       OK \] (\S+) \((\d+) ms\)/gm)]
    .filter(([, , ms]) => Number(ms) < quick_ms).map(([, name]) => name);
}

function run(program, files) {
  const flags = path.join(fs.mkdtempSync(path.join(os.tmpdir(), 'limits_')), 'flags');
  const known = process.env.QUICK_TESTS;  // file of names, one a line: a list that was made before
  const tests = known && fs.existsSync(known) ? fs.readFileSync(known, 'utf8').trim().split('\n')
                                              : quick_tests(program);
  if (known) fs.writeFileSync(known, tests.join('\n') + '\n');
  fs.writeFileSync(flags, `--gtest_filter=${tests.join(':')}\n--gtest_brief=1\n--gtest_fail_fast=1\n`);
  const failed = (name, factor) => {
    const { stdout, signal } = spawnSync(program, [`--gtest_flagfile=${flags}`],
      { encoding: 'utf8', maxBuffer: 1 << 28, timeout: 120e3, env: { ...process.env, SANDHOPPER_LIMIT: `${name}=${factor}` } });
    return stdout.match(/^\[  FAILED  \] (\S+?)[, ]/m)?.[1] ?? (signal ? `(${signal})` : 'none');
  };
  console.log('| constant | x 0.5 | x 2 |\n|---|---|---|');
  for (const name of files.flatMap(written)) console.log(`| ${name} | ${failed(name, 0.5)} | ${failed(name, 2)} |`);
}

const [verb, ...words] = process.argv.slice(2);
if (verb === 'write') words.forEach(write);
else if (verb === 'run') run(words[0], words.slice(1));
else throw new Error('write FILE…, or run UNIT_TESTS FILE…');
