/** Over the side view: what the legs' joints can do, and what the motors give. */

import { degrees, fixed } from "../geometry/format";
import { robotDocument } from "../state/setup";

const turn = (range: readonly number[]) =>
  range.map((angle) => `${fixed(degrees(angle), 0)}°`).join(" to ");

export function Ranges() {
  const file = robotDocument.value;
  if (!file) return null;
  return (
    <div class="captions">
      {(["rear", "front"] as const).map((end) => {
        const { thigh, calf } = file.joints[end];
        const motors = (end === "rear" && file.rear?.actuators) || file.actuators;
        const upper = motors.thigh ?? motors.leg;
        const lower = motors.calf ?? motors.leg;
        const same = upper?.torque === lower?.torque;
        return (
          <p key={end} class={end}>
            <b>
              {end === "rear" ? "Rear" : "Front"}: thigh {turn(thigh)}, calf {turn(calf)}
            </b>
            <span>
              motor{same ? "" : "s"} {fixed(upper?.torque ?? 0, 1)}
              {same ? "" : ` and ${fixed(lower?.torque ?? 0, 1)}`} Nm, wheel{" "}
              {fixed(motors.wheel.torque, 1)} Nm
            </span>
          </p>
        );
      })}
    </div>
  );
}
