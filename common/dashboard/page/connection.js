// A WebSocket that comes back by itself, and says when it is gone.

const PING_MS = 1000;
const SILENT_MS = 3500; // a live stream answers each ping
const FIRST_WAIT_MS = 250;
const LONGEST_WAIT_MS = 4000;
const GOING_AWAY = 1001; // RFC 6455, section 7.4.1: the server ends

/** Calls `handlers`: state(word), message(object), image(buffer), delay(ms). */
export class Connection {
  #socket = null;
  #wait = FIRST_WAIT_MS;
  #lastMessageAt = 0;
  #timer = 0;
  #wantsField = false;
  #stopped = false; // whether the monitor said that it ends

  constructor(robot, handlers) {
    this.robot = robot;
    this.handlers = handlers;
    this.#beat = setInterval(() => this.#check(), PING_MS);
    this.#open();
  }
  #beat;

  #open() {
    const scheme = location.protocol === "https:" ? "wss:" : "ws:";
    const path = `/api/v1/robots/${encodeURIComponent(this.robot)}/stream`;
    const socket = new WebSocket(`${scheme}//${location.host}${path}`);
    socket.binaryType = "arraybuffer";
    this.#socket = socket;
    this.#lastMessageAt = performance.now();
    socket.onopen = () => this.#wantsField && this.#send({ type: "field", on: true });
    socket.onmessage = ({ data }) => socket === this.#socket && this.#receive(data);
    socket.onclose = ({ code }) => socket === this.#socket && this.#lose(code === GOING_AWAY);
  }

  #receive(data) {
    this.#lastMessageAt = performance.now();
    if (typeof data !== "string") return this.handlers.image(data);
    const message = JSON.parse(data);
    if (message.type === "pong") return this.handlers.delay((performance.now() - message.t) / 2);
    if (message.type === "snapshot") {
      this.#wait = FIRST_WAIT_MS;
      this.#stopped = false;
      this.handlers.state("live");
      this.#ping();
    }
    this.handlers.message(message);
  }

  #lose(stopped = false) {
    this.#socket = null;
    this.#stopped ||= stopped;
    this.handlers.state(this.#stopped ? "stopped" : "lost");
    this.#timer = setTimeout(() => this.#open(), this.#wait);
    this.#wait = Math.min(LONGEST_WAIT_MS, this.#wait * 2);
  }

  #check() {
    if (!this.#socket) return;
    if (performance.now() - this.#lastMessageAt > SILENT_MS) {
      const socket = this.#socket;
      this.#lose();
      socket.close();
    } else {
      this.#ping();
    }
  }

  #ping() {
    this.#send({ type: "ping", t: performance.now() });
  }

  #send(message) {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(message));
  }

  /** Whether images of the field are wanted. */
  field(on) {
    this.#wantsField = on;
    this.#send({ type: "field", on });
  }

  close() {
    clearInterval(this.#beat);
    clearTimeout(this.#timer);
    const socket = this.#socket;
    this.#socket = null;
    socket?.close();
  }
}
