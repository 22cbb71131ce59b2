// A tool that connects to the live interface: the client of the Foxglove WebSocket protocol that
// others wrote, and messages decoded by their schemas.
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import protocol from "@foxglove/ws-protocol";
import WebSocket from "ws";

const { FoxgloveClient } = protocol;
const PATIENCE_MS = 120_000; // a machine may be slow; nothing is timed

export const result = { failures: 0 };
export function expect(is_true, text) {
  console.log(`${is_true ? "ok    " : "FAILED"} ${text}`);
  if (!is_true) result.failures += 1;
}

// Waits until `probe` gives something; undefined after PATIENCE_MS.
export async function eventually(probe, what) {
  const end = Date.now() + PATIENCE_MS;
  while (Date.now() < end) {
    const found = await probe();
    if (found) return found;
    await new Promise((done) => setTimeout(done, 10));
  }
  expect(false, `${what} within ${PATIENCE_MS / 1000} s`);
  return undefined;
}

export const definitions = (schema) => parse(schema, { ros2: true });
export const reader_of = (schema) => new MessageReader(definitions(schema));

// A client that collects everything and decodes every message at once.
export class Tool {
  constructor(link, subprotocols) {
    const { host } = new URL(link);
    const token = link.split("token=")[1];
    this.socket = new WebSocket(`ws://${host}/live?token=${token}`, subprotocols);
    this.client = new FoxgloveClient({ ws: this.socket });
    this.channels = new Map(); // by topic
    this.services = new Map(); // by name
    this.newest = new Map(); // by topic
    this.counts = new Map();
    this.statuses = [];
    this.responses = new Map();
    this.values = [];
    this.assets = new Map();
    this.events = [];
    const subscribed = new Map(); // topic and reader by subscription
    this.client.on("error", (error) => expect(false, String(error)));
    this.client.on("serverInfo", (info) => (this.info = info));
    this.client.on("advertise", (channels) => {
      for (const channel of channels) this.channels.set(channel.topic, channel);
    });
    this.client.on("advertiseServices", (services) => {
      for (const service of services) this.services.set(service.name, service);
    });
    this.client.on("message", ({ subscriptionId, timestamp, data }) => {
      const { topic, reader } = subscribed.get(subscriptionId);
      const message = reader.readMessage(data);
      this.newest.set(topic, message);
      this.stamp = timestamp;
      this.counts.set(topic, (this.counts.get(topic) ?? 0) + 1);
      if (topic === "/hapticgiant/events") this.events.push(message);
    });
    this.client.on("time", ({ timestamp }) => (this.time = timestamp));
    this.client.on("status", (status) => this.statuses.push(status.message));
    this.client.on("serviceCallResponse", (response) => this.responses.set(response.callId, response));
    this.client.on("serviceCallFailure", (failure) => this.responses.set(failure.callId, failure));
    this.client.on("parameterValues", (values) => this.values.push(values));
    this.client.on("fetchAssetResponse", (asset) => this.assets.set(asset.requestId, asset));
    this.subscribe = (topic) => {
      const channel = this.channels.get(topic);
      const id = this.client.subscribe(channel.id);
      subscribed.set(id, { topic, reader: reader_of(channel.schema) });
      return id;
    };
  }

  async greeted() {
    await eventually(() => this.info && this.channels.size > 0 && this.services.size > 0, "the greeting");
  }

  // Calls a service; the decoded response.
  async call(name) {
    const service = this.services.get(`/hapticgiant/${name}`);
    this.calls = (this.calls ?? 0) + 1;
    const callId = this.calls;
    const data = new DataView(new Uint8Array([0, 1, 0, 0, 0]).buffer);
    this.client.sendServiceCallRequest({ serviceId: service.id, callId, encoding: "cdr", data });
    const response = await eventually(() => this.responses.get(callId), `the response of ${name}`);
    return reader_of(service.response.schema).readMessage(response.data);
  }

  async parameters(names, id) {
    this.client.getParameters(names, id);
    const answer = await eventually(() => this.values.find((values) => values.id === id), id);
    return answer.parameters;
  }

  close() {
    this.client.close();
  }
}

export const POSE = `
std_msgs/Header header
geometry_msgs/Pose pose
===
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
===
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
===
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
===
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
===
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w`;
export const WRENCH = POSE.replace("geometry_msgs/Pose pose", "geometry_msgs/Wrench wrench")
  .replace("MSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation",
    "MSG: geometry_msgs/Wrench\ngeometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque")
  .replace("MSG: geometry_msgs/Point", "MSG: geometry_msgs/Vector3");
