// Compares a log as read by @mcap/core, with messages decoded by Foxglove's parser of ros2msg schemas, with what this
// project's own reader prints; then cuts it at 200 random bytes.  node compare.mjs READER LOG WORK_FOLDER
import { crc32 } from '@foxglove/crc';
import { parse } from '@foxglove/rosmsg';
import { MessageReader, MessageWriter } from '@foxglove/rosmsg2-serialization';
import { McapIndexedReader, McapStreamReader } from '@mcap/core';
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const [reader_program, log, work] = process.argv.slice(2);
const file = new Uint8Array(readFileSync(log));
const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
const kRecordHead = 9;
const kChunkHead = 40;

const own = args => execFileSync(reader_program, args, { encoding: 'utf8', maxBuffer: 2 ** 31 });

function bits_of(value) {
  if (Number.isNaN(value)) return 'nan';
  const scratch = new DataView(new ArrayBuffer(8));
  scratch.setFloat64(0, value);
  return scratch.getBigUint64(0).toString(16).padStart(16, '0');
}

// Paths and values in the order of the schema, in the format of `reference_log dump`.
function flatten(types, type, object, prefix, out) {
  const definition = types.find(t => t.name === type);
  for (const field of definition.definitions) {
    if (field.isConstant) continue;
    const path = prefix === '' ? field.name : `${prefix}.${field.name}`;
    const values = field.isArray ? Array.from(object[field.name]) : [object[field.name]];
    if (field.isArray) assert.equal(values.length, field.arrayLength, path);
    values.forEach((value, i) => {
      const place = field.isArray ? `${path}.${i}` : path;
      if (field.isComplex) return flatten(types, field.type, value, place, out);
      out.paths.push(place);
      out.values.push(field.type === 'float64' ? bits_of(value) : String(BigInt(value)));
    });
  }
  return out;
}

async function read_indexed() {
  const readable = {
    size: async () => BigInt(file.length),
    read: async (offset, size) => file.subarray(Number(offset), Number(offset + size)),
  };
  return McapIndexedReader.Initialize({ readable });
}

// Reads all records in the order of the file and checks the CRCs of chunks and attachments.
function read_stream(bytes) {
  const reader = new McapStreamReader();
  reader.append(bytes);
  const records = [];
  for (let record; (record = reader.nextRecord()) !== undefined; ) records.push(record);
  return { records, done: reader.done() };
}

function compare_messages(records) {
  const schemas = new Map();
  const channels = new Map();
  const decoders = new Map();
  const counts = {};
  let values = 0;
  const lines = own(['dump', log]).split('\n');
  let line = 0;
  for (const record of records) {
    if (record.type === 'Schema') schemas.set(record.id, record);
    if (record.type === 'Channel') channels.set(record.id, record);
    if (record.type !== 'Message') continue;
    const channel = channels.get(record.channelId);
    assert.equal(channel.messageEncoding, 'cdr');
    if (!decoders.has(record.channelId)) {
      const schema = schemas.get(channel.schemaId);
      assert.equal(schema.encoding, 'ros2msg');
      const types = parse(new TextDecoder().decode(schema.data), { ros2: true });
      const main = types.find(t => t.name === undefined);
      main.name = schema.name;
      const decoder = new MessageReader(types);
      decoders.set(record.channelId, { types, main: schema.name, decoder, writer: new MessageWriter(types) });
    }
    const { types, main, decoder, writer } = decoders.get(record.channelId);
    const object = decoder.readMessage(record.data);
    assert.ok(!decoder.lastReadHadTrailingBytes(), `${channel.topic}: bytes left over`);
    assert.deepEqual(Buffer.from(writer.writeMessage(object)), Buffer.from(record.data),
      `${channel.topic}: encoded again, the bytes differ`);
    const flat = flatten(types, main, object, '', { paths: [], values: [] });
    if (counts[channel.topic] === undefined) {
      assert.deepEqual(JSON.parse(lines[line++]), { topic: channel.topic, paths: flat.paths });
      counts[channel.topic] = 0;
    }
    assert.deepEqual(JSON.parse(lines[line++]), {
      topic: channel.topic, sequence: record.sequence, log: String(record.logTime),
      publish: String(record.publishTime), values: flat.values,
    });
    ++counts[channel.topic];
    values += flat.values.length;
  }
  assert.equal(lines.slice(line).join(''), '', 'our reader found more messages');
  return { counts, values };
}

// End of every message in the file and its time, from the message indexes.
function message_ends(indexed) {
  const ends = [];
  for (const chunk of indexed.chunkIndexes) {
    const records_start = Number(chunk.chunkStartOffset) + kRecordHead + kChunkHead;
    for (const place of chunk.messageIndexOffsets.values()) {
      const list = Number(place) + kRecordHead + 2 + 4;
      const bytes = view.getUint32(list - 4, true);
      for (let at = list; at < list + bytes; at += 16) {
        const start = records_start + Number(view.getBigUint64(at + 8, true));
        assert.equal(view.getUint8(start), 5, 'the index points at something else than a message');
        ends.push({ end: start + kRecordHead + Number(view.getBigUint64(start + 1, true)),
          time: view.getBigUint64(at, true) });
      }
    }
  }
  return ends.sort((a, b) => a.end - b.end);
}

function compare_cuts(ends) {
  let state = 12345;
  const random = () => (state = (state * 1103515245 + 12345) % 2147483648) / 2147483648;
  const cut_file = join(work, 'cut.mcap');
  let most_beyond_reference = 0;
  const kCuts = 200;
  for (let i = 0; i < kCuts; ++i) {
    const cut = Math.floor(random() * file.length);
    writeFileSync(cut_file, file.subarray(0, cut));
    const whole = ends.filter(message => message.end <= cut);
    const expected = `${whole.length} ${whole.length > 0 ? whole.at(-1).time : 0}`;
    const [messages, last, truncated_at] = own(['count', cut_file]).trim().split(' ');
    assert.equal(`${messages} ${last}`, expected, `cut at byte ${cut}`);
    assert.ok(Number(truncated_at) >= 0 && Number(truncated_at) <= cut, `cut at ${cut}: said ${truncated_at}`);
    const reference = read_stream(file.subarray(0, cut)).records.filter(record => record.type === 'Message').length;
    assert.ok(reference <= whole.length);
    most_beyond_reference = Math.max(most_beyond_reference, whole.length - reference);
  }
  rmSync(cut_file, { force: true });
  return `${kCuts} random cuts: each read to its last whole message; up to ${most_beyond_reference} messages more than ` +
    'the reference reader gives, which drops a cut chunk';
}

const { records, done } = read_stream(file);
assert.ok(done, 'the reference reader does not see the end');
const indexed = await read_indexed();
const data_crc = crc32(file.subarray(0, Number(indexed.dataEndOffset)));
assert.equal(indexed.dataSectionCrc, data_crc, 'CRC of the data section');
assert.equal(indexed.header.profile, 'ros2');

const { counts, values } = compare_messages(records);
const statistics = indexed.statistics;
const total = Object.values(counts).reduce((a, b) => a + b, 0);
assert.equal(Number(statistics.messageCount), total);
for (const channel of indexed.channelsById.values())
  assert.equal(Number(statistics.channelMessageCounts.get(channel.id)), counts[channel.topic] ?? 0, channel.topic);

let by_index = 0;
let last_time = 0n;
for await (const message of indexed.readMessages({ validateCrcs: true })) {
  assert.ok(message.logTime >= last_time);
  last_time = message.logTime;
  ++by_index;
}
assert.equal(by_index, total, 'messages found through the index');

let attachments = 0;
for await (const attachment of indexed.readAttachments({ validateCrcs: true })) {
  assert.ok(attachment.data.length > 0, attachment.name);
  ++attachments;
}
let metadata = 0;
for await (const entry of indexed.readMetadata()) metadata += entry.metadata.size > 0 ? 1 : 0;

const ends = message_ends(indexed);
assert.equal(ends.length, total, 'messages in the message indexes');
const topics = Object.entries(counts).map(([topic, count]) => `${topic} ${count}`).join(', ');
console.log(`${log}: ${file.length} bytes, ${statistics.chunkCount} chunks, ${attachments} attachments, ` +
  `${metadata} metadata`);
console.log(`${indexed.channelsById.size} channels, ${total} messages (${topics}), ${values} values: equal in both ` +
  'readers, bit for bit');
console.log(compare_cuts(ends));
