/** Friction: typed, stepped, or dragged by its label; the plan follows. */

import { fixed } from "../geometry/format";
import { commit, draft, drawing, drawnFriction } from "../state/drawing";
import { Icon } from "../ui/icon";
import { NumberField } from "../ui/number-field";

const LEAST = 0.05;
const MOST = 2;
/** Dragging the label sideways. */
const PER_PIXEL = 0.005;

export function Friction() {
  const set = (next: number) =>
    draft({ friction: Math.round(Math.min(MOST, Math.max(LEAST, next)) * 1000) / 1000 });
  const step = (by: number) => () => {
    set(drawing.peek().friction + by);
    commit();
  };
  return (
    <div class="fld box">
      <small
        class="scrubbable"
        aria-hidden="true"
        title="Drag sideways to change"
        onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)}
        onPointerMove={(event) =>
          event.buttons === 1 && set(drawing.peek().friction + event.movementX * PER_PIXEL)
        }
        onPointerUp={() => commit()}
      >
        <span class="of">Friction</span> <span class="wide">μ</span>
      </small>
      <NumberField
        label="Friction coefficient"
        value={drawnFriction.value}
        min={LEAST}
        max={MOST}
        step={0.01}
        format={(v) => fixed(v, v === Number(v.toFixed(2)) ? 2 : 3)}
        onChange={set}
        onDone={() => commit()}
        onCancel={() => commit()}
      />
      <span class="stp">
        <button type="button" tabIndex={-1} aria-label="More friction" onClick={step(0.05)}>
          <Icon name="down" turn />
        </button>
        <button type="button" tabIndex={-1} aria-label="Less friction" onClick={step(-0.05)}>
          <Icon name="down" />
        </button>
      </span>
    </div>
  );
}
