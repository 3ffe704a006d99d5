/** The map itself: a canvas, what lies under the pointer or the keys, and its card. */

import { effect } from "@preact/signals";
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";
import { theme } from "../state/view";
import { Card } from "./card";
import { spoken } from "./cell";
import { boxOf, type Place, placeAt } from "./frame";
import { openCell } from "./open-cell";
import { inkOf } from "./palette";
import { paint } from "./shapes";
import { cursor, frameFor, pictureFor, pinned } from "./view";

/** The card comes once the pointer rests on a cell [ms]. */
const PATIENCE = 100;

const MOVES: Record<string, readonly [number, number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

export function MapView() {
  const root = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const [size, setSize] = useState({ w: 0, h: 0 });
  const [card, setCard] = useState(false);
  const timer = useRef<ReturnType<typeof setTimeout> | undefined>(undefined);

  useLayoutEffect(() => {
    const watch = new ResizeObserver(([entry]) => {
      const { width, height } = entry!.contentRect;
      setSize({ w: Math.floor(width), h: Math.floor(height) });
    });
    watch.observe(root.current!);
    return () => watch.disconnect();
  }, []);

  const frame = size.w > 0 ? frameFor(size.w, size.h) : null;

  // Not with the component: the cursor moves far more often than the picture changes.
  useEffect(
    () =>
      effect(() => {
        theme.value; // changes the ink
        const context = canvas.current?.getContext("2d");
        const drawn = size.w > 0 && frameFor(size.w, size.h);
        if (!context || !drawn) return;
        const picture = pictureFor(drawn, inkOf(root.current!));
        const ratio = devicePixelRatio || 1;
        canvas.current!.width = size.w * ratio;
        canvas.current!.height = size.h * ratio;
        context.setTransform(ratio, 0, 0, ratio, 0, 0);
        paint(context, picture);
      }),
    [size],
  );

  const point = (place: Place | null, patience: number) => {
    cursor.value = place;
    clearTimeout(timer.current);
    if (!place) setCard(false);
    else if (!card) timer.current = setTimeout(() => setCard(true), patience);
  };
  const at = (event: PointerEvent | MouseEvent): Place | null => {
    const box = root.current!.getBoundingClientRect();
    return frame && placeAt(frame, event.clientX - box.left, event.clientY - box.top);
  };
  const same = (a: Place | null, b: Place | null) =>
    a === b || (a !== null && b !== null && a.i === b.i && a.j === b.j && a.panel === b.panel);

  const onKeyDown = (event: KeyboardEvent) => {
    if (!frame) return;
    const { nx, ny } = frame.panels[0]!;
    const now = cursor.peek() ?? { panel: 0, i: Math.floor(nx / 2), j: Math.floor(ny / 2) };
    const move = MOVES[event.key];
    if (move) {
      const by = event.shiftKey ? 5 : 1;
      const clamp = (v: number, n: number) => Math.max(0, Math.min(n - 1, v));
      const next = cursor.peek()
        ? { ...now, i: clamp(now.i + move[0] * by, nx), j: clamp(now.j + move[1] * by, ny) }
        : now;
      point(next, 0);
    } else if (event.key === "Enter" && cursor.peek()) void openCell(now);
    else if (event.key === " " && cursor.peek()) pinned.value = now;
    else if (event.key === "Escape") point(null, 0);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };

  const place = cursor.value;
  return (
    <div
      class="map-canvas"
      ref={root}
      role="application"
      aria-label="Capability map. Arrows move from cell to cell, Enter opens it as a plan, Space keeps it."
      // biome-ignore lint/a11y/noNoninteractiveTabindex: it is driven by keys
      tabIndex={0}
      onKeyDown={onKeyDown}
      onPointerMove={(event) => {
        const next = at(event);
        if (!same(next, cursor.peek())) point(next, PATIENCE);
      }}
      onPointerLeave={() => point(null, 0)}
      onBlur={() => point(null, 0)}
      onClick={(event) => {
        const hit = at(event);
        if (!hit) return;
        if (event.shiftKey) pinned.value = hit;
        else void openCell(hit);
      }}
    >
      <canvas ref={canvas} style={{ width: `${size.w}px`, height: `${size.h}px` }} />
      {frame && <Mark frame={frame} place={pinned.value} kind="pin" />}
      {frame && <Mark frame={frame} place={place} kind="cur" />}
      {frame && place && card && <Card frame={frame} place={place} />}
      <div class="sr" aria-live="polite">
        {place ? spoken(place) : ""}
      </div>
    </div>
  );
}

interface MarkProps {
  frame: NonNullable<ReturnType<typeof frameFor>>;
  place: Place | null;
  kind: "pin" | "cur";
}

/** Around a cell; side by side, around its twin too: two maps, one pointer. */
function Mark({ frame, place, kind }: MarkProps) {
  if (!place || place.i >= frame.panels[0]!.nx || place.j >= frame.panels[0]!.ny) return null;
  return (
    <>
      {frame.panels.map((_, panel) => {
        const box = boxOf(frame, { ...place, panel });
        const style = {
          left: `${box.x}px`,
          top: `${box.y}px`,
          width: `${box.w}px`,
          height: `${box.h}px`,
        };
        return <i key={panel} class={`map-mark ${kind}`} style={style} />;
      })}
    </>
  );
}
