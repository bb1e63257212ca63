// Why no data comes, as far as the nodes say. No page, no network.

const MOST = 3;
const ORDER = ["lms_reader", "ros2_gateway", "replayer", "emulator", "bridge", "map_server", "boundary_extractor", "accumulator", "peak_extractor", "tracker"];
const HINTS = {
  lms_reader: "check the laser: power, cable, address (backcast probe)",
  ros2_gateway: "check the ROS 2 robot: router, domain, topic of the scans",
  bridge: "check the network to the other machine",
  map_server: "check the map file that --map names",
};
const PLAYERS = ["replayer", "emulator"];

const place = (name) => (ORDER.includes(name) ? ORDER.indexOf(name) : ORDER.length);

const inOrder = (nodes) => [...nodes.values()].sort((a, b) => place(a.name) - place(b.name));

/** Nodes that do not work while others do; a sentence each. */
export const troubles = ({ nodes }) => inOrder(nodes)
  .filter(({ state }) => state === "silent" || state === "degraded").map(problem).slice(0, MOST);

/** Sentences, the first cause first. */
export function whatToCheck({ nodes, map }) {
  const all = inOrder(nodes);
  if (!all.length) return ["No node has reported: is the graph started? See backcast status."];
  const found = all.map(problem).filter(Boolean);
  if (!map && !found.length) found.push("No map has come: check map_server, and the map file that --map names.");
  const sources = all.filter(({ name }) => place(name) < ORDER.indexOf("map_server"));
  if (!found.length && sources.length && sources.every(({ sent_hz }) => !sent_hz)) {
    const [{ name }] = sources;
    found.push(`${name} sends no scans: ${HINTS[name] ?? "check the laser: power, cable, address"}.`);
  }
  if (!found.length && !sources.length) found.push("No node that reads a laser has reported: is it started, and what is its name? See backcast status.");
  if (!found.length) found.push("Scans come, and no pose: check accumulator, peak_extractor and tracker (backcast logs).");
  return found.slice(0, MOST);
}

function problem({ name, state, last_error }) {
  const hint = HINTS[name] ? `: ${HINTS[name]}` : "";
  const why = last_error ? `: ${last_error}` : "";
  switch (state) {
    case "silent": return `${name} does not report any more: see backcast logs ${name}.`;
    case "stopped": return PLAYERS.includes(name) ? "The recording has ended." : `${name} has ended: see backcast logs ${name}.`;
    case "degraded": return `${name} is degraded${why}${hint}.`;
    case "waiting": return last_error.startsWith("waiting for ") ? `${name} is ${last_error}${hint}.` : `${name} waits${why}${hint}.`;
    case "busy": return `${name} prepares a map: wait.`;
    default: return "";
  }
}
