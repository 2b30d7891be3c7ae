// Lists a ROS 1 bag as @foxglove/rosbag reads it: a line a message, "topic type log-time-ns bytes".
import { Bag } from "@foxglove/rosbag";
import { FileReader } from "@foxglove/rosbag/node.js";

const bag = new Bag(new FileReader(process.argv[2]));
await bag.open();
let count = 0;
for await (const result of bag.messageIterator()) {
  const connection = bag.connections.get(result.connectionId);
  const ns = BigInt(result.timestamp.sec) * 1000000000n + BigInt(result.timestamp.nsec);
  console.log(result.topic, connection.type, ns.toString(), result.data.byteLength);
  if (result.message === undefined) throw new Error(`no message of ${connection.type}`);
  ++count;
}
console.log("#", count, "messages");
