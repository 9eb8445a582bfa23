// Prints the contents of a file as read by the official MCAP reader, as JSON.
//
//   node read.js READER FILE
//
// READER is a folder with node_modules/@mcap/core, made by scripts/setup mcap. Exit code 77: the
// reader is missing; 1: it rejects the file.
'use strict';

const crypto = require('node:crypto');
const fs = require('node:fs/promises');
const { createRequire } = require('node:module');
const path = require('node:path');

const [folder, file] = process.argv.slice(2);
const requireThere = createRequire(path.join(folder, 'package.json'));
let mcap;
let crc;
try {
  mcap = requireThere('@mcap/core');
  crc = requireThere('@foxglove/crc');
} catch (error) {
  if (error.code !== 'MODULE_NOT_FOUND') throw error;
  process.exit(77);
}

/** What is said about a sequence of messages. */
class Messages {
  constructor() {
    this.count = 0;
    this.inOrder = true;
    this.last = -1n;
    this.counts = {};
    this.hash = crypto.createHash('sha256');
    this.frames = new Set();
    this.undescribed = new Set();
  }

  add(topic, schema, message) {
    const next = this.counts[topic] || 0;
    this.inOrder = this.inOrder && message.logTime >= this.last && message.sequence === next
      && message.publishTime === message.logTime;
    this.last = message.logTime;
    this.counts[topic] = next + 1;
    this.count += 1;
    this.hash.update(`${topic} ${message.sequence} ${message.logTime} `).update(message.data);
    const content = JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(message.data));
    for (const key of Object.keys(content)) {
      if (!(key in schema.properties)) this.undescribed.add(key);
    }
    if (content.child_frame_id !== undefined) {
      this.frames.add(content.parent_frame_id).add(content.child_frame_id);
    }
  }

  said() {
    return {
      messages: this.count, in_order: this.inOrder, counts: this.counts, digest: this.hash.digest('hex'),
    };
  }
}

/** From the first byte to the last, with all checksums of chunks. */
function readStream(bytes, found) {
  const reader = new mcap.McapStreamReader({ includeChunks: true, validateCrcs: true });
  const schemas = new Map();
  const channels = new Map();
  const messages = new Messages();
  found.checksums = { data: false, summary: false, chunks: 0 };
  reader.append(bytes);
  for (let record; (record = reader.nextRecord());) {
    if (record.type === 'Schema') schemas.set(record.id, JSON.parse(new TextDecoder().decode(record.data)));
    if (record.type === 'Channel') channels.set(record.id, record);
    if (record.type === 'Message') {
      const { topic, schemaId } = channels.get(record.channelId);
      messages.add(topic, schemas.get(schemaId), record);
    }
    if (record.type === 'Chunk' && record.uncompressedCrc !== 0) found.checksums.chunks += 1;
    if (record.type === 'Footer') found.checksums.summary = record.summaryCrc !== 0;
  }
  if (!reader.done()) throw new Error('the file ends too early');
  found.stream = messages.said();
  found.frames = [...messages.frames];
  found.undescribed = [...messages.undescribed];
}

/** By the index, with the checksum of the summary. */
async function readIndexed(bytes, found) {
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
  };
  const reader = await mcap.McapIndexedReader.Initialize({ readable });
  const messages = new Messages();
  for await (const message of reader.readMessages()) {
    const { topic, schemaId } = reader.channelsById.get(message.channelId);
    messages.add(topic, JSON.parse(new TextDecoder().decode(reader.schemasById.get(schemaId).data)), message);
  }
  found.indexed = messages.said();
  found.from_5_to_6_s = 0;
  const second = reader.readMessages({ startTime: 5_000_000_000n, endTime: 6_000_000_000n });
  for await (const message of second) found.from_5_to_6_s += message ? 1 : 0;
  found.header = { profile: reader.header.profile, library: reader.header.library };
  found.chunks = reader.chunkIndexes.length;
  found.schemas = reader.schemasById.size;
  found.channels = {};
  for (const { topic, schemaId, messageEncoding } of reader.channelsById.values()) {
    const { name, encoding } = reader.schemasById.get(schemaId);
    found.channels[topic] = { schema: name, encoding: messageEncoding, schema_encoding: encoding };
  }
  const { statistics } = reader;
  found.statistics = {
    messages: Number(statistics.messageCount),
    schemas: statistics.schemaCount,
    channels: statistics.channelCount,
    chunks: statistics.chunkCount,
    first: String(statistics.messageStartTime),
    last: String(statistics.messageEndTime),
    counts: Object.fromEntries(Array.from(statistics.channelMessageCounts,
      ([id, count]) => [reader.channelsById.get(id).topic, Number(count)])),
  };
  // The reader does not check the checksum of the data section: it would have to read all of it.
  const record = 1 + 8 + 4;
  const end = bytes.length - mcap.McapConstants.MCAP_MAGIC.length;
  const footer = end - (1 + 8 + 8 + 8 + 4);
  const summary = Number(new DataView(bytes.buffer, bytes.byteOffset).getBigUint64(footer + 9, true));
  found.checksums.data = crc.crc32(bytes.subarray(0, summary - record)) === reader.dataSectionCrc;
}

(async () => {
  const bytes = new Uint8Array(await fs.readFile(file));
  const found = {};
  readStream(bytes, found);
  await readIndexed(bytes, found);
  process.stdout.write(`${JSON.stringify(found)}\n`);
})().catch((error) => {
  console.error(String(error));
  process.exit(1);
});
