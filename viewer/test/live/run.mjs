// Judges the live interface by software that others wrote: the client of the Foxglove WebSocket
// protocol (@foxglove/ws-protocol), ROS 2 decoding by @foxglove/rosmsg2-serialization, and the
// recording of the same run by @mcap/core.
//
//   node test/live/run.mjs PROGRAM
//
// Then the recording is played for the same client.
//
// One run of the door with a person at the mouse: `hand` of this test is the only hand.
import { mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader } from "@mcap/core";
import { decompress } from "fzstd";

import { start_program } from "../browser/browser.mjs";
import { POSE, Tool, WRENCH, definitions, eventually, expect, reader_of, result } from "./tool.mjs";

const TOPICS = {
  "/joint_states": "sensor_msgs/msg/JointState",
  "/twin/joint_states": "sensor_msgs/msg/JointState",
  "/user_wrench": "geometry_msgs/msg/WrenchStamped",
  "/handle_twist": "geometry_msgs/msg/TwistStamped",
  "/tf": "tf2_msgs/msg/TFMessage",
  "/limits": "sensor_msgs/msg/JointState",
  "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
  "/hapticgiant/events": "hapticgiant_msgs/msg/Event",
  "/hapticgiant/sample": "hapticgiant_msgs/msg/Sample",
  "/robot_description": "std_msgs/msg/String",
  "/twin/robot_description": "std_msgs/msg/String",
};
const RECORDED = Object.keys(TOPICS).filter((topic) => !["/limits", "/diagnostics"].includes(topic));

const [ARMED, RUNNING] = [2, 3]; // record.mode

async function topics_and_time(tool) {
  await tool.greeted();
  for (const [topic, type] of Object.entries(TOPICS)) {
    expect(tool.channels.get(topic)?.schemaName === type, `${topic} is advertised as ${type}`);
    tool.subscribe(topic);
  }
  const late = ["/hapticgiant/events"];
  await eventually(
    () => Object.keys(TOPICS).every((topic) => late.includes(topic) || tool.newest.has(topic)),
    "a message of every topic",
  );
  const joints = tool.newest.get("/joint_states");
  expect(joints.name.length === 8 && joints.position.every(Number.isFinite), "eight joints of the device");
  const links = tool.newest.get("/tf").transforms.map((transform) => transform.child_frame_id);
  for (const link of ["handle", "elbow", "twin_end", "m6", "ppu1", "twin/leaf", "twin/lever"]) {
    expect(links.includes(link), `/tf has ${link}`);
  }
  expect(new Set(links).size === links.length, "each frame of /tf has one parent");
  expect(tool.newest.get("/robot_description").data.includes("<robot"), "the URDF is latched");
  const limits = tool.newest.get("/limits");
  expect(limits.name.includes("hinge") && limits.effort.length === limits.name.length, "limits by name");
  const states = tool.newest.get("/diagnostics").status.map((status) => status.name);
  expect(states.length === 3, `diagnostics: ${states.join(", ")}`);
  const { sec, nsec, nanosec } = joints.header.stamp;
  expect(Math.abs(sec - Date.now() / 1000) < 3600 && (nsec ?? nanosec) >= 0, "stamps are the time of the run");
  const before = tool.time;
  await eventually(() => tool.time > before, "the time advances");
}

async function services(tool) {
  const mode = () => tool.newest.get("/hapticgiant/sample")?.record.mode;
  await eventually(() => mode() === RUNNING, "the device runs");
  for (const name of ["tare", "arm", "reset"]) {
    const refused = await tool.call(name);
    expect(!refused.success && refused.message.length > 0, `${name} is refused: ${refused.message}`);
  }
  expect((await tool.call("stop")).success, "stop");
  await eventually(() => mode() === ARMED, "the device has stopped");
  const run = await tool.call("run");
  expect(run.success, `run: ${run.message}`);
  await eventually(() => mode() === RUNNING, "the device runs again");
  const mark = await tool.call("mark");
  expect(mark.success, "mark");
  await eventually(() => tool.events.some((event) => event.name === "mark"), "the mark is an event");
}

async function parameters(tool, other) {
  const all = await tool.parameters([], "all");
  const damping = all.find(({ name }) => name === "hinge.damping_Nms_per_rad");
  expect(damping !== undefined && Number.isFinite(damping.value), `${all.length} parameters`);
  await other.greeted();
  other.client.subscribeParameterUpdates([damping.name]);
  tool.client.setParameters([{ name: damping.name, value: damping.value + 1 }], "set");
  const answer = await eventually(() => tool.values.find(({ id }) => id === "set"), "the answer of set");
  expect(answer.parameters[0].value === damping.value + 1, "the new value is answered");
  const got = await eventually(() => other.values[0], "a subscriber gets it");
  expect(got.parameters[0].value === damping.value + 1, "with the new value");
  const [now] = await tool.parameters([damping.name], "again");
  expect(now.value === damping.value + 1, "and it is in force");

  const known = tool.statuses.length;
  tool.client.setParameters([{ name: damping.name, value: -5 }], "bad");
  const refused = await eventually(() => tool.values.find(({ id }) => id === "bad"), "the answer of bad");
  expect(refused.parameters[0].value === damping.value + 1, "out of range: the present value is answered");
  const status = await eventually(() => tool.statuses[known], "a status");
  expect(status.includes(damping.name) && status.includes("-5"), `and reported: ${status}`);
  tool.client.setParameters([{ name: "hinge.dampng_Nms_per_rad", value: 1 }], "typo");
  const typo = await eventually(() => tool.statuses[known + 1], "a status");
  expect(typo.includes("'hinge.damping_Nms_per_rad'"), `an unknown name: ${typo}`);
}

async function publishing(tool) {
  const pose = tool.client.advertise({ topic: "/hand_target", encoding: "cdr", schemaName: "geometry_msgs/msg/PoseStamped", schema: POSE, schemaEncoding: "ros2msg" });
  const writer = new MessageWriter(definitions(POSE));
  const handle = tool.newest.get("/tf").transforms.find((one) => one.child_frame_id === "handle");
  const { x, y, z } = handle.transform.translation;
  const target = (frame_id, shift) =>
    writer.writeMessage({
      header: { stamp: { sec: 0, nanosec: 0 }, frame_id },
      pose: { position: { x: x + shift, y, z }, orientation: { x: 0, y: 0, z: 0, w: 0 } },
    });
  const hand = () => tool.newest.get("/hapticgiant/sample").operator_input.hand_target;
  await eventually(() => {
    tool.client.sendMessage(pose, target("base", 0.05));
    return hand().active && Math.abs(hand().p_b[0] - x - 0.05) < 1e-9;
  }, "the hand follows /hand_target");
  await eventually(() => !hand().active, "a silent hand lets go");
  const known = tool.statuses.length;
  tool.client.sendMessage(pose, target("map", 0.05));
  const status = await eventually(() => tool.statuses[known], "a status");
  expect(status.includes("'map'"), `a target in another frame is refused: ${status}`);

  const wrench = tool.client.advertise({ topic: "/reference_wrench", encoding: "cdr", schemaName: "geometry_msgs/msg/WrenchStamped", schema: WRENCH, schemaEncoding: "ros2msg" });
  const wrench_writer = new MessageWriter(definitions(WRENCH));
  const force = wrench_writer.writeMessage({
    header: { stamp: { sec: 0, nanosec: 0 }, frame_id: "base" },
    wrench: { force: { x: 3, y: 0, z: 0 }, torque: { x: 0, y: 0, z: 0 } },
  });
  const value = async (id) => (await tool.parameters(["reference_wrench.force_N.x"], id))[0].value;
  let asked = 0;
  await eventually(async () => {
    tool.client.sendMessage(wrench, force);
    asked += 1;
    return (await value(`wrench ${asked}`)) === 3;
  }, "the reference wrench is in force");
  tool.client.unadvertise(wrench);
  await eventually(async () => {
    asked += 1;
    return (await value(`wrench ${asked}`)) === 0;
  }, "and zero when its client ends it");
}

async function assets(tool) {
  tool.client.fetchAsset("package://hapticgiant/device.urdf", 1);
  const urdf = await eventually(() => tool.assets.get(1), "the asset");
  expect(new TextDecoder().decode(urdf.data).includes("<robot"), "the URDF is an asset");
  tool.client.fetchAsset("package://hapticgiant/../secret", 2);
  const none = await eventually(() => tool.assets.get(2), "an answer");
  expect(none.status === 1 && none.error.includes("no asset"), `no other file: ${none.error}`);
}

const facts = ({ record }) => `${record.state_hash} ${record.twin.q_a}`;

// Every message of the recording, decoded by what Foxglove uses; the file, and its samples by time.
async function recording(folder) {
  const [name] = readdirSync(folder).filter((file) => file.startsWith("door_"));
  const bytes = readFileSync(join(folder, name));
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
  };
  const decompressHandlers = { zstd: (data, size) => decompress(data, new Uint8Array(Number(size))) };
  const mcap = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const readers = new Map();
  const counts = new Map();
  const samples = new Map();
  for (const channel of mcap.channelsById.values()) {
    const schema = mcap.schemasById.get(channel.schemaId);
    expect(schema.encoding === "ros2msg" && channel.messageEncoding === "cdr", `${channel.topic} is ROS 2`);
    readers.set(channel.id, reader_of(new TextDecoder().decode(schema.data)));
  }
  for await (const message of mcap.readMessages()) {
    const { topic } = mcap.channelsById.get(message.channelId);
    const content = readers.get(message.channelId).readMessage(message.data);
    if (topic === "/hapticgiant/sample") samples.set(content.record.time_s, facts(content));
    counts.set(topic, (counts.get(topic) ?? 0) + 1);
  }
  for (const topic of RECORDED) expect(counts.get(topic) > 0, `${counts.get(topic)} recorded of ${topic}`);
  return { file: join(folder, name), samples };
}

// The recording is played: its samples come again.
async function replay({ file, samples }) {
  const player = await start_program([process.argv[2], "replay", file, "--view", "--speed", "0.5",
    "--no-browser"]);
  const tool = new Tool(player.link, ["foxglove.websocket.v1"]);
  await tool.greeted();
  for (const topic of Object.keys(TOPICS)) tool.subscribe(topic);
  await eventually(() => Object.keys(TOPICS).every((topic) => tool.newest.has(topic)), "every topic of a replay");
  const first = tool.newest.get("/hapticgiant/sample");
  const next = await eventually(() => {
    const newest = tool.newest.get("/hapticgiant/sample");
    return newest.record.time_s > first.record.time_s && newest;
  }, "the replay continues");
  for (const sample of [first, next]) {
    const { time_s } = sample.record;
    expect(samples.get(time_s) === facts(sample), `at ${time_s} s as recorded: ${facts(sample)}`);
  }
  const refused = await tool.call("stop");
  expect(!refused.success && refused.message.includes("recording"), `stop is refused: ${refused.message}`);
  tool.close();
  await player.stop();
}

const folder = mkdtempSync(join(tmpdir(), "hg_live_"));
const command = [process.argv[2], "run", "door", "--user", "mouse", "--no-browser", "--recordings", folder];
const program = await start_program([...command, "--duration", "100000"]);
try {
  const tool = new Tool(program.link, ["foxglove.websocket.v1"]);
  const other = new Tool(program.link, ["foxglove.sdk.v1"]);
  await topics_and_time(tool);
  await services(tool);
  await parameters(tool, other);
  await publishing(tool);
  await assets(tool);
  expect(other.socket.protocol === "foxglove.sdk.v1", "both subprotocols");
  tool.close();
  other.close();
  await program.stop();
  await replay(await recording(folder));
} catch (error) {
  expect(false, String(error.stack));
}
await program.stop();
rmSync(folder, { recursive: true });
process.exit(result.failures === 0 ? 0 : 1);
