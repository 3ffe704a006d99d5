/** The axes of a study that are neither x nor y: one of their values is shown at a time. */

import { fixed } from "../geometry/format";
import { axisKind } from "./quantities";
import { layout, robotAxis, slices, study } from "./state";

export function Slices() {
  const axes = (layout.value?.others ?? [])
    .map((k) => study.value!.axes[k]!)
    .filter((axis) => axis !== robotAxis.value && axis.values.length > 1);
  if (axes.length === 0) return null;
  return (
    <div class="slices">
      {axes.map((axis) => {
        const kind = axisKind(axis.name, axis.unit);
        return (
          <div key={axis.name} class="r2">
            <span>{kind.title}</span>
            <div class="seg" role="radiogroup" aria-label={kind.title}>
              {axis.values.map((value, k) => {
                const on = (slices.value[axis.name] ?? 0) === k;
                return (
                  <button
                    key={value}
                    type="button"
                    role="radio"
                    aria-checked={on}
                    class={on ? "on" : ""}
                    onClick={() => {
                      slices.value = { ...slices.peek(), [axis.name]: k };
                    }}
                  >
                    {typeof value === "number" ? fixed(value, kind.digits) : value}
                  </button>
                );
              })}
            </div>
            <small>{kind.unit}</small>
          </div>
        );
      })}
    </div>
  );
}
