/** What changed weights bring: quantities of the plan, with default weights and now. */

import type { Plan } from "../api/types";
import { fixed, maybe } from "../geometry/format";
import { legLimits } from "../geometry/robot";
import { MARGINS, marginClass, worst } from "../profile-editor/margins";
import { defaultPlan, ghostShown } from "../state/effect";
import { plan, robot, stale } from "../state/planning";
import { changedWeights, weightSchema } from "../state/setup";
import { Switch } from "../ui/switch";

interface Quantity {
  title: string;
  hint?: string;
  unit: string;
  /** Part of the name of the weight that is meant to improve it. */
  weight: string;
  of: (shown: Plan) => string;
  /** Whether it is thin or worse. */
  thin: (shown: Plan) => boolean;
}

const [CLEARANCE, COM, FRICTION, TORQUE] = MARGINS as [
  (typeof MARGINS)[number],
  (typeof MARGINS)[number],
  (typeof MARGINS)[number],
  (typeof MARGINS)[number],
];

const isThin = (kind: (typeof MARGINS)[number]) => (shown: Plan) =>
  marginClass(kind, worst(shown.poses, kind.name)) < 2;
const least = (kind: (typeof MARGINS)[number]) => (shown: Plan) =>
  kind.read(worst(shown.poses, kind.name), shown);

/** The limit of thigh and calf motors [Nm]; null where it is not the same for all. */
function legLimit(): number | null {
  const all = robot.value ? legLimits(robot.value.limits) : [];
  return all.length === 1 ? all[0]! : null;
}

const QUANTITIES: readonly Quantity[] = [
  { title: "CoM margin", unit: "mm", weight: "com", of: least(COM), thin: isThin(COM) },
  {
    title: "Clearance",
    unit: "mm",
    weight: "clearance",
    of: least(CLEARANCE),
    thin: isThin(CLEARANCE),
  },
  {
    title: "Friction needed",
    unit: "",
    weight: "friction",
    of: least(FRICTION),
    thin: isThin(FRICTION),
  },
  {
    get title() {
      return legLimit() === null ? "Torque left" : "Static torque";
    },
    unit: "Nm",
    weight: "torque",
    of: (shown) => {
      const left = worst(shown.poses, "torque");
      const limit = legLimit();
      return fixed(limit === null ? left : limit - left, 1);
    },
    thin: isThin(TORQUE),
  },
  {
    title: "Time",
    unit: "s",
    weight: "speed",
    of: (shown) => fixed(shown.timing.total, 1),
    thin: () => false,
  },
  {
    title: "Energy",
    hint: "Work of the motors' static torques along the plan, without losses",
    unit: "J",
    weight: "energy",
    of: (shown) => maybe(shown.energy, 0),
    thin: () => false,
  },
  {
    title: "Cost of transport",
    hint: "That energy per unit of weight and distance",
    unit: "",
    weight: "energy",
    of: (shown) => maybe(shown.cost_of_transport, 2),
    thin: () => false,
  },
];

/** Whether a weight that is meant for it was raised over its default. */
function raised(part: string): boolean {
  return Object.entries(changedWeights.value).some(([name, value]) => {
    const first = weightSchema.value[name]?.default;
    return name.includes(part) && typeof first === "number" && Number(value) > first;
  });
}

export function Effect() {
  if (Object.keys(changedWeights.value).length === 0) return null;
  const before = defaultPlan.value;
  const now = plan.value;
  if (!before || !now || stale.value) {
    return <p class="effect-wait">Planning with default weights, to compare …</p>;
  }
  if (before.problem || now.problem) {
    const which = before.problem ? (now.problem ? "Neither finds" : "Only these weights find") : "";
    return <p class="effect-wait">{which || "Only the default weights find"} a way over it.</p>;
  }
  return (
    <section class="effect" aria-label="Effect of the weights">
      <table>
        <thead class="sr">
          <tr>
            <th scope="col">Quantity</th>
            <th scope="col">Default weights</th>
            <th scope="col">Now</th>
          </tr>
        </thead>
        <tbody>
          {QUANTITIES.map((each) => {
            const worse = each.thin(now) && !each.thin(before);
            const wanted = raised(each.weight) && each.of(now) !== each.of(before);
            return (
              <tr key={each.title}>
                <th scope="row" title={each.hint}>
                  {each.title}
                </th>
                <td>{each.of(before)} →</td>
                <td class={worse ? "x" : wanted ? "wanted" : ""}>
                  <b>{each.of(now)}</b> {each.unit}
                </td>
              </tr>
            );
          })}
        </tbody>
      </table>
      <div class="ghost-row">
        <span>Draw the default path dashed</span>
        <Switch
          label="Draw the default path dashed"
          on={ghostShown.value}
          onChange={(on) => {
            ghostShown.value = on;
          }}
        />
      </div>
    </section>
  );
}
