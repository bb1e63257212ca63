// What is known of the robot that is watched. No page, no network.

import { isOn } from "./situation.js";

const TRACK = 3000;
const LATENCIES = 120;
const EVENTS = 200;
const STATES = 300;
const HOUR_MS = 3600 * 1000;

/** A state with when it began, by the clock of this page. */
const began = (period) => ({ ...period, at: performance.now() - 1000 * period.ago_s });

/** A node's report with when it was made, by the same clock. */
const reported = (node) => ({ ...node, at: performance.now() - 1000 * node.quiet_s });

export class Store {
  constructor() {
    this.clear();
    this.events = [];
  }

  clear() {
    Object.assign(this, {
      robot: "", graph: null, states: [], rawScanAt: null, map: null, cells: null, answer: null, pose: null, scanAt: null, posedAt: null, beams: null, beamsAt: 0, scans: new Map(), scanPose: null, field: null,
      nodes: new Map(), track: [], region: [], latencies: [], missed: 0,
      abilities: { region: false, save: false, hint: false, restart: false }, recording: null,
    });
  }

  /** Takes a message; returns which part it changed. */
  receive(message) {
    switch (message.type) {
      case "snapshot": return this.#snapshot(message);
      case "map": this.map = message; this.field = null; return "map";
      case "answer": return this.#answer(message);
      case "pose": return this.#pose(message);
      case "state": return this.#state(message);
      case "beams": this.beams = message; this.beamsAt = performance.now(); return "beams";
      case "scan": return this.#scan(message);
      case "node": return this.#node(message);
      case "log": return this.#log(message);
      case "region": this.region = message.corners; return "region";
      case "abilities": this.abilities = message; return "abilities";
      case "recording": this.recording = message; return "recording";
      case "missed":
        this.missed += message.messages;
        this.event(`${message.messages} messages were missed: this page is too slow`, "warn");
        return "missed";
      default: return "nothing";
    }
  }

  #snapshot({ robot, graph, map, answer, pose, ages, states, beams, nodes, track, log, region, abilities, recording }) {
    Object.assign(this, { robot, graph, map, answer, pose, beams, track, region, abilities, recording });
    this.states = states.map(began);
    const since = (seconds) => (seconds === null ? null : performance.now() - 1000 * seconds);
    this.scanAt = since(ages.scan_s);
    this.posedAt = since(ages.pose_s);
    this.nodes = new Map(nodes.map((node) => [node.name, reported(node)]));
    for (const line of log) this.#log(line);
    return "snapshot";
  }

  #answer(answer) {
    const verdict = this.answer?.verdict;
    if (verdict !== answer.verdict && !this.pose) {
      const level = { Unique: "good", Ambiguous: "warn", PoorFit: "bad" }[answer.verdict] ?? "warn";
      this.event(`${answer.verdict}: ${answer.says}`, level);
    }
    this.#scanned(answer.age_ms);
    if (!this.pose) this.#went(this.answer, answer, answer.hypotheses[0]?.laser, answer.verdict);
    if (!this.pose) this.#stands(answer.verdict, answer.hypotheses[0]?.base ?? answer.hypotheses[0]?.laser);
    this.answer = answer;
    return "answer";
  }

  /** Takes where the tracker has the robot, with a scan or between scans. */
  #pose(pose) {
    if (this.pose?.state !== pose.state) {
      const level = { Unique: "good", Lost: "bad" }[pose.state] ?? "warn";
      this.event(`${pose.state}: ${pose.says}`, level);
    }
    if (!this.pose) this.track = [];
    if (pose.from_scan) {
      this.#scanned(pose.age_ms);
      this.#went(this.pose, pose, pose.laser, pose.state);
      this.scanPose = pose;
    }
    this.#stands(pose.state, pose.base ?? pose.laser);
    this.pose = pose;
    this.posedAt = performance.now() - pose.sent_age_ms;
    return "pose";
  }

  /** Takes the end points of a laser's newest scan. */
  #scan(scan) {
    this.scans.set(scan.laser, scan);
    this.rawScanAt = performance.now();
    return "scan";
  }

  /** Another state begins; what is older than an hour is let go of. */
  #state(message) {
    const period = began(message);
    const kept = (_, i) => i === this.states.length - 1 || period.at - this.states[i + 1].at < HOUR_MS;
    this.states = [...this.states.filter(kept), period].slice(-STATES);
    return "state";
  }

  /** Where the robot is while the newest state lasts. */
  #stands(state, pose) {
    const period = this.states.at(-1);
    if (period?.state === state && pose) period.last = pose;
  }

  /** When the newest scan came, by the clock of this page. */
  #scanned(age_ms) {
    this.scanAt = Math.max(this.scanAt ?? -Infinity, performance.now() - age_ms);
  }

  /** The way goes on, or begins anew on another map. */
  #went(before, now, laser, word) {
    if (before && before.map_id !== now.map_id) this.track = [];
    if (laser) this.track.push([laser.x, laser.y, word[0], laser.yaw]);
    if (this.track.length > TRACK) this.track.shift();
    this.latencies.push(now.latency_ms);
    if (this.latencies.length > LATENCIES) this.latencies.shift();
  }

  /** Seconds since the newest scan or, with a tracker, its newest pose, whichever is
   * older; null before the first. */
  silence() {
    const newest = this.pose ? Math.min(this.scanAt ?? Infinity, this.posedAt) : this.scanAt;
    return newest === null ? null : (performance.now() - newest) / 1000;
  }

  /** Where the robot is on the map that is shown: what the tracker says or, without one, the
   * last scan. */
  best() {
    const place = this.pose ? (this.pose.laser ? this.pose : null) : this.answer?.hypotheses[0];
    return place && isOn(this.map, place) ? place : null;
  }

  #node(node) {
    const before = this.nodes.get(node.name);
    if (before?.state !== node.state) {
      const level = { silent: "bad", degraded: "warn" }[node.state] ?? "good";
      const word = node.state === "silent" ? "does not report any more" : `is ${node.state}`;
      this.event(`${node.name} ${word}`, level, node.name);
    }
    if (before && node.restarts > before.restarts) this.event(`${node.name} was started again`, "warn", node.name);
    if (node.last_error && node.last_error !== before?.last_error) {
      this.event(`${node.name}: ${node.last_error}`, "warn", node.name);
    }
    this.nodes.set(node.name, reported(node));
    return "nodes";
  }

  /** Takes a line of a node's log, if it is not there already. */
  #log({ node, pid, counter, level, at_s, text }) {
    const key = `${node} ${pid} ${counter}`;
    if (this.events.some((event) => event.key === key)) return "log";
    const grave = { debug: "faint", info: "info", warn: "warn", error: "bad" }[level] ?? "info";
    this.#insert({ at: new Date(at_s * 1000), text, node, level: grave, key });
    return "log";
  }

  /** Takes a binary message: the length of a head, the head as JSON, pixels. */
  image(buffer) {
    const length = new DataView(buffer).getUint32(0, true);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
    this.field = { ...head, pixels: new Uint8Array(buffer, 4 + length) };
  }

  event(text, level = "good", node = "page") {
    this.#insert({ at: new Date(), text, level, node });
  }

  /** Newest first, wherever it comes from. */
  #insert(event) {
    const at = this.events.findIndex((other) => other.at <= event.at);
    this.events = this.events.toSpliced(at < 0 ? this.events.length : at, 0, event).slice(0, EVENTS);
  }
}
