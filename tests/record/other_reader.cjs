// tests/record/other_reader.cjs - reads a recording with the MCAP project's own reader and
// decodes Protocol Buffers with protobufjs, without any code of burr. Exit code 77: they are not
// installed.
//
//     npm install @mcap/core @mcap/nodejs fzstd protobufjs;  NODE_PATH=node_modules node other_reader.cjs F.mcap
let mcap, nodejs, fzstd, protobuf, fs;
try {
  mcap = require("@mcap/core");
  nodejs = require("@mcap/nodejs");
  fzstd = require("fzstd");
  protobuf = require("protobufjs");
  require("protobufjs/ext/descriptor");
  fs = require("fs/promises");
} catch (problem) {
  console.log("not installed: " + problem.message.split("\n")[0]);
  process.exit(77);
}

const decompressHandlers = { zstd: (data, size) => fzstd.decompress(data, new Uint8Array(Number(size))) };

async function indexed(path) {
  const handle = await fs.open(path);
  const reader = await mcap.McapIndexedReader.Initialize({
    readable: new nodejs.FileHandleReadable(handle), decompressHandlers });
  const types = new Map();
  for (const schema of reader.schemasById.values()) {
    if (schema.encoding !== "protobuf") continue;
    const root = protobuf.Root.fromDescriptor(protobuf.util.newBuffer
      ? protobuf.util.newBuffer(schema.data) : schema.data);
    types.set(schema.id, root.lookupType(schema.name));
  }
  const out = { messages: {}, ticks: 0, first_x: null, last_x: null, commands: 0, bricks: 0, session: null,
                attachments: 0, metadata: [], statistics: Number(reader.statistics.messageCount) };
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    out.messages[channel.topic] = (out.messages[channel.topic] ?? 0) + 1;
    if (channel.topic === "/ticks") {
      const ticks = types.get(channel.schemaId).decode(message.data);
      if (ticks.hand_x_m === undefined && ticks.handXM === undefined) throw new Error("no hand_x_m");
      const x = ticks.hand_x_m ?? ticks.handXM;
      out.ticks += x.length;
      out.first_x ??= x[0];
      out.last_x = x[x.length - 1];
    }
    if (channel.topic === "/bone/changes") {
      const bricks = types.get(channel.schemaId).decode(message.data);
      if (bricks.field.length !== bricks.brick.length * 1024) throw new Error("field and brick disagree");
      out.bricks += bricks.brick.length;
    }
    const text = () => JSON.parse(new TextDecoder().decode(message.data));
    if (channel.topic === "/wishes") { text(); ++out.commands; }
    if (channel.topic === "/session") out.session = text().volume.content_hash;
  }
  for await (const attachment of reader.readAttachments()) out.attachments += attachment.data.length > 0;
  for await (const metadata of reader.readMetadata()) out.metadata.push(metadata.name);
  await handle.close();
  return out;
}

async function streamed(path) {
  const reader = new mcap.McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(await fs.readFile(path));
  let messages = 0;
  for (let record; (record = reader.nextRecord());) messages += record.type === "Message";
  if (!reader.done()) throw new Error("the stream reader is not done");
  return messages;
}

(async () => {
  const out = await indexed(process.argv[2]);
  out.streamed = await streamed(process.argv[2]);
  console.log(JSON.stringify(out));
})().catch((problem) => { console.error(problem); process.exit(1); });
