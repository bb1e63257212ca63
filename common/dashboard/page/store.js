// What is known of the robot that is watched. No page, no network.

const TRACK = 3000;
const LATENCIES = 120;
const EVENTS = 200;

export class Store {
  constructor() {
    this.clear();
    this.events = [];
  }

  clear() {
    Object.assign(this, {
      robot: "", map: null, cells: null, answer: null, pose: null, scanAt: null, posedAt: null, beams: null, beamsAt: 0, field: null,
      nodes: new Map(), track: [], region: [], latencies: [], missed: 0,
      abilities: { region: false, save: false },
    });
  }

  /** Takes a message; returns which part it changed. */
  receive(message) {
    switch (message.type) {
      case "snapshot": return this.#snapshot(message);
      case "map": this.map = message; this.field = null; return "map";
      case "answer": return this.#answer(message);
      case "pose": return this.#pose(message);
      case "beams": this.beams = message; this.beamsAt = performance.now(); return "beams";
      case "node": return this.#node(message);
      case "log": return this.#log(message);
      case "region": this.region = message.corners; return "region";
      case "abilities": this.abilities = message; return "abilities";
      case "missed":
        this.missed += message.messages;
        this.event(`${message.messages} messages were missed: this page is too slow`, "warn");
        return "missed";
      default: return "nothing";
    }
  }

  #snapshot({ robot, map, answer, pose, ages, beams, nodes, track, log, region, abilities }) {
    Object.assign(this, { robot, map, answer, pose, beams, track, region, abilities });
    const since = (seconds) => (seconds === null ? null : performance.now() - 1000 * seconds);
    this.scanAt = since(ages.scan_s);
    this.posedAt = since(ages.pose_s);
    this.nodes = new Map(nodes.map((node) => [node.name, node]));
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
    }
    this.pose = pose;
    this.posedAt = performance.now() - pose.sent_age_ms;
    return "pose";
  }

  /** When the newest scan came, by the clock of this page. */
  #scanned(age_ms) {
    this.scanAt = Math.max(this.scanAt ?? -Infinity, performance.now() - age_ms);
  }

  /** The way goes on, or begins anew on another map. */
  #went(before, now, laser, word) {
    if (before && before.map_id !== now.map_id) this.track = [];
    if (laser) this.track.push([laser.x, laser.y, word[0]]);
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

  /** Where the robot is: what the tracker says or, without one, the last scan. */
  best() {
    if (!this.pose) return this.answer?.hypotheses[0] ?? null;
    return this.pose.laser ? this.pose : null;
  }

  #node(node) {
    const before = this.nodes.get(node.name);
    if (before?.state !== node.state) {
      const level = { silent: "bad", degraded: "warn" }[node.state] ?? "good";
      const word = node.state === "silent" ? "does not report any more" : `is ${node.state}`;
      this.event(`${node.name} ${word}`, level);
    }
    if (before && node.restarts > before.restarts) this.event(`${node.name} was started again`, "warn");
    if (node.last_error && node.last_error !== before?.last_error) {
      this.event(`${node.name}: ${node.last_error}`, "warn");
    }
    this.nodes.set(node.name, node);
    return "nodes";
  }

  /** Takes a line of a node's log, if it is not there already. */
  #log({ node, pid, counter, level, at_s, text }) {
    const key = `${node} ${pid} ${counter}`;
    if (this.events.some((event) => event.key === key)) return "log";
    const grave = { debug: "faint", info: "info", warn: "warn", error: "bad" }[level] ?? "info";
    this.#insert({ at: new Date(at_s * 1000), text: `${node}: ${text}`, level: grave, key });
    return "log";
  }

  /** Takes a binary message: the length of a head, the head as JSON, pixels. */
  image(buffer) {
    const length = new DataView(buffer).getUint32(0, true);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
    this.field = { ...head, pixels: new Uint8Array(buffer, 4 + length) };
  }

  event(text, level = "good") {
    this.#insert({ at: new Date(), text, level });
  }

  /** Newest first, wherever it comes from. */
  #insert(event) {
    const at = this.events.findIndex((other) => other.at <= event.at);
    this.events = this.events.toSpliced(at < 0 ? this.events.length : at, 0, event).slice(0, EVENTS);
  }
}
