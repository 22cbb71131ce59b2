// The technical words of the page, each with what it means. `also`: other forms and phrases that
// stand for it; one with a capital stands for it only so, as a button has it.

export interface Entry {
  word: string;
  also: string[];
  text: string;
}

export const WORDS: Entry[] = [
  // what there is
  {
    word: "device",
    also: ["robot"],
    text: "The robot that holds the handle. It moves so that the hand feels the twin. Blue on this page.",
  },
  {
    word: "twin",
    also: [],
    text: "The simulated mechanism that the hand feels: a door, a drawer, a body that floats. It is computed, the device makes it felt. Orange on this page.",
  },
  {
    word: "handle",
    also: [],
    text: "What the hand holds. It belongs to device and twin at once: both must be at the same place.",
  },
  {
    word: "joint",
    also: ["joints", "slide", "hinge"],
    text: "A hinge or a slide between two parts. Each has one position, and mostly two ends.",
  },
  {
    word: "gantry",
    also: ["prepositioning"],
    text: "The slides that carry the arm of a large device along the room. They follow the hand, so that the arm stays in the middle of its reach.",
  },
  // what is felt
  {
    word: "force",
    also: ["forces"],
    text: "With how many newtons the hand pushes or pulls, as the sensor at the handle measures it: 10 N is about the weight of 1 kg. The red arrow.",
  },
  {
    word: "torque",
    also: ["torques"],
    text: "How strongly the hand turns the handle, or a motor its joint, in newton metres: 1 Nm is 10 N at a lever of 10 cm. The violet arc.",
  },
  {
    word: "wrench",
    also: [],
    text: "Force and torque together.",
  },
  {
    word: "limit",
    also: ["limits"],
    text: "What must not be exceeded: the end of a joint, a highest speed, the edge of the workspace. A limit that acts pushes back, and is felt as a wall or a drag.",
  },
  {
    word: "limits in conflict",
    also: ["contradict each other"],
    text: "Two limits that cannot both hold, as a twin that must move and a device that must not. The one of higher priority wins.",
  },
  {
    word: "priority",
    also: [],
    text: "Which limit gives way when not all can hold: 1 never does, larger numbers do earlier.",
  },
  {
    word: "range",
    also: [],
    text: "All positions between the two ends of a joint.",
  },
  {
    word: "workspace",
    also: ["hand x", "hand y", "hand z"],
    text: "The box in which the handle may be; hand x, y and z are its walls. Drawn as thin lines.",
  },
  {
    word: "motor",
    also: [],
    text: "The drive of a joint. It has a largest torque, and a largest speed at which it can change it.",
  },
  {
    word: "singularity",
    also: [],
    text: "A posture in which the device cannot move the handle in one direction, however fast its joints are: an arm that is stretched out. A limit keeps away from it.",
  },
  {
    word: "self-collision",
    also: ["hit itself"],
    text: "Parts of the device that would touch each other, or the floor. A limit stops them a few centimetres before.",
  },
  {
    word: "locked",
    also: [],
    text: "A joint of the twin that does not move at all until something releases it, as a door whose lever is not pressed.",
  },
  {
    word: "latched",
    also: [],
    text: "A joint of the twin that moves one way only: a door that closes, but does not open.",
  },
  {
    word: "what carries the twin",
    also: ["base of the twin"],
    text: "The place where the twin stands, when it moves: the deck of a ship, a vehicle. Brown on this page; dashed where it rests.",
  },
  // where the force goes
  {
    word: "mass",
    also: ["masses", "inertia"],
    text: "What makes a body slow to start and to stop. Its force grows with acceleration, and is nothing at steady speed.",
  },
  {
    word: "damping",
    also: ["damped"],
    text: "A resistance that grows with speed, as in honey.",
  },
  {
    word: "springs",
    also: ["spring", "stiffness", "closers", "closer"],
    text: "A force that grows with the way from where the spring rests. A closer is a spring that shuts a door.",
  },
  {
    word: "friction",
    also: [],
    text: "A resistance that hardly depends on speed, and holds a joint that stands still.",
  },
  {
    word: "surfaces",
    also: ["virtual surface", "virtual surfaces", "surface"],
    text: "Planes, boxes and balls of the twin's world that the handle can touch and cannot enter.",
  },
  {
    word: "reference",
    also: [],
    text: "The wrench at which the twin rests. With a weight as reference, a hand that holds it against gravity keeps it still.",
  },
  {
    word: "bearings",
    also: [],
    text: "What holds a joint to its axis. Who pushes a door towards its hinge pushes against its bearings: it does not move.",
  },
  {
    word: "rest",
    also: [],
    text: "What no other line explains. Close to zero while the device runs.",
  },
  // teleoperation
  {
    word: "remote machine",
    also: ["remote"],
    text: "A machine elsewhere that your hand leads. What it meets, you feel. Green on this page; see-through where it is to be.",
  },
  {
    word: "teleoperation",
    also: [],
    text: "To lead a machine that is elsewhere, and to feel what it touches.",
  },
  {
    word: "clutch",
    also: [],
    text: "Couples your hand to the remote machine. While it is open, the hand moves alone; when it closes, the machine stays where it is and follows from there.",
  },
  {
    word: "link",
    also: [],
    text: "What carries packets between both sides: it has a delay, jitter, and losses.",
  },
  {
    word: "jitter",
    also: [],
    text: "How much the delays of packets that follow each other differ, on average.",
  },
  {
    word: "packet",
    also: ["packets"],
    text: "One message of one side to the other, sent once per cycle.",
  },
  {
    word: "port",
    also: ["operator's port", "remote port"],
    text: "Where a side takes and gives energy: at your hand, and at the remote machine.",
  },
  {
    word: "energy",
    also: ["energies"],
    text: "Force times way, in joules. Two ports that together only take energy cannot shake up by themselves.",
  },
  {
    word: "dissipated",
    also: [],
    text: "Energy that the method has turned into nothing, so that no side gives more than it got.",
  },
  // what can be changed
  {
    word: "law",
    also: [],
    text: "The rule by which limits of device and twin share what the hand pushes. The laws differ in what is felt when several limits act at once.",
  },
  // safety
  {
    word: "emergency stop",
    also: [],
    text: "Takes the power off the device and closes its brakes at once. It stays pressed until it is released.",
  },
  {
    word: "enabling switch",
    also: [],
    text: "A switch that the operator holds while the device may move. Letting it go stops the device.",
  },
  {
    word: "dead-man switch",
    also: ["dead-man"],
    text: "A switch in the handle, closed while a hand holds it. Letting go stops the device.",
  },
  {
    word: "override key",
    also: [],
    text: "A key that lets the device move slowly while no hand holds the handle.",
  },
  {
    word: "person in the field",
    also: ["scanner"],
    text: "A person besides the user stands where the laser scanner watches. The device stops.",
  },
  {
    word: "fault",
    also: [],
    text: "Something is wrong, and the device has stopped for it. It must be reset by hand once the cause is gone.",
  },
  {
    word: "reset",
    also: [],
    text: "Ends a fault whose cause is gone. The device is ready then, and still without power.",
  },
  {
    word: "ready",
    also: [],
    text: "Drives off, brakes closed, no fault: the device can be armed.",
  },
  {
    word: "armed",
    also: ["Arm"],
    text: "Drives on, brakes open; the device holds still and waits for a hand.",
  },
  {
    word: "running",
    also: ["Run", "Run alone"],
    text: "The hand moves the device, and feels the twin.",
  },
  {
    word: "held",
    also: ["Hold", "held under power"],
    text: "The device brakes, then stands still with its drives on.",
  },
  {
    word: "drives",
    also: ["drive", "drives off"],
    text: "The motors of the joints with their electronics. With drives off the brakes hold the device.",
  },
  {
    word: "brakes",
    also: ["braked", "brake"],
    text: "Hold the joints without power. To brake is to slow down under control before they close.",
  },
  {
    word: "tare",
    also: ["tared"],
    text: "The weight of the handle is subtracted from what the sensor measures, once, while no hand touches it.",
  },
  // figures
  {
    word: "cycle",
    also: ["cycles"],
    text: "One pass of the controller, mostly 1000 in a second; the figure is the time that one takes to compute.",
  },
  {
    word: "frames",
    also: [],
    text: "Pictures of the state that the program sends to this page, 60 in a second.",
  },
  {
    word: "sensor",
    also: ["sensors"],
    text: "Measures force and torque between device and handle. Its delay is the age of what it says.",
  },
];

export interface Found {
  begin: number;
  end: number;
  entry: Entry;
}

const FORMS = new Map(
  WORDS.flatMap((entry) => [entry.word, ...entry.also].map((form) => [form, entry])),
);
// longer ones first: "limits in conflict" is not "limits"
const ANY = [...FORMS.keys()].sort((a, b) => b.length - a.length).join("|");
const PATTERN = new RegExp(`(?<![\\w-])(?:${ANY})(?![\\w-])`, "gi");

// "joint" and "twin" of "joint of the twin", in the order of the text.
export function words_in(text: string): Found[] {
  return [...text.matchAll(PATTERN)].flatMap(({ 0: form, index }) => {
    const entry = FORMS.get(form) ?? FORMS.get(form.toLowerCase());
    return entry ? [{ begin: index, end: index + form.length, entry }] : [];
  });
}
