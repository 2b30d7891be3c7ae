// Lists an MCAP file as @mcap/core reads it: a line a message, "topic type log-time-ns bytes".
import { open } from "node:fs/promises";
import { McapIndexedReader } from "@mcap/core";

const file = await open(process.argv[2]);
const readable = {
  size: async () => BigInt((await file.stat()).size),
  read: async (offset, length) => {
    const bytes = new Uint8Array(Number(length));
    const { bytesRead } = await file.read(bytes, 0, bytes.length, Number(offset));
    if (bytesRead !== bytes.length) throw new Error("the file ends too early");
    return bytes;
  },
};
const reader = await McapIndexedReader.Initialize({ readable });
for (const channel of reader.channelsById.values()) {
  if (reader.schemasById.get(channel.schemaId) === undefined) throw new Error(channel.topic);
}
for await (const message of reader.readMessages()) {
  const channel = reader.channelsById.get(message.channelId);
  const schema = reader.schemasById.get(channel.schemaId);
  console.log(channel.topic, schema.name.replace("/msg/", "/"), message.logTime.toString(),
    message.data.length);
}
const count = reader.statistics.messageCount.toString();
const metadata = [];
for await (const record of reader.readMetadata()) metadata.push(record.name);
console.log("#", count, "messages", reader.header.profile, metadata.join(" "));
await file.close();
