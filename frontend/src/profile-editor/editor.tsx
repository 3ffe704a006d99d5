/** The profile editor: one SVG from the grid up to the corners, with its gestures. */

import { useLayoutEffect, useRef } from "preact/hooks";
import type { Vec2 } from "../api/types";
import { committed, drawing } from "../state/drawing";
import { outdated, preview } from "../state/planning";
import { robotName } from "../state/setup";
import { tool } from "../state/view";
import { DimensionField } from "./dimension-field";
import { EmptyCanvas } from "./empty";
import {
  cancelGesture,
  dragging,
  MOVE_EVENT,
  move,
  press,
  release,
  spaceHeld,
  splitSegment,
  type Target,
} from "./gestures";
import { Grid, Rulers } from "./grid";
import { KeyNumbers, pressKey } from "./key-numbers";
import { Banner, FirstHint, Legend } from "./notices";
import { Obstruction, Refusal } from "./obstruction";
import { Current, Ghosts } from "./poses";
import { Readout } from "./readout";
import { RibbonPatterns, SpeedRibbon } from "./speed-ribbon";
import { Dimensions, Ground, WheelPath } from "./terrain-layer";
import { Toolbar } from "./toolbar";
import { Veil } from "./veil";
import { Guides, Stretches, Vertices } from "./vertices";
import { canvasBox, fit, moved, pan, refit, size, toWorld, zoomAt } from "./viewport";

function targetOf(event: Event): Target {
  const element = event.target as Element;
  const vertex = element.closest<SVGElement>("[data-vertex]");
  if (vertex) return { kind: "vertex", index: Number(vertex.dataset.vertex) };
  const segment = element.closest<SVGElement>("[data-segment]");
  if (segment) return { kind: "segment", index: Number(segment.dataset.segment) };
  return { kind: "canvas", index: -1 };
}

function Canvas() {
  const svg = useRef<SVGSVGElement>(null);
  const local = (event: PointerEvent | MouseEvent): Vec2 => {
    const rect = svg.current!.getBoundingClientRect();
    return [event.clientX - rect.left, event.clientY - rect.top];
  };
  const onPointerDown = (event: PointerEvent) => {
    if ((event.target as Element).closest("[data-dimension]")) return;
    if (pressKey(event)) return;
    const target = targetOf(event);
    svg.current!.setPointerCapture(event.pointerId);
    if (target.kind === "vertex") {
      svg
        .current!.querySelector<SVGElement>(`[data-vertex="${target.index}"]`)
        ?.focus({ preventScroll: true });
    } else (document.activeElement as HTMLElement | null)?.blur?.();
    event.preventDefault();
    press(event, local(event), target);
  };
  const onWheel = (event: WheelEvent) => {
    event.preventDefault();
    const sideways = event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY);
    if (sideways && !event.ctrlKey)
      pan(-(event.deltaX || event.deltaY), event.shiftKey ? 0 : -event.deltaY);
    else zoomAt(...local(event), Math.exp(-event.deltaY * (event.ctrlKey ? 0.01 : 0.0015)));
  };
  const onDblClick = (event: MouseEvent) => {
    const target = targetOf(event);
    if (target.kind === "segment") splitSegment(target.index, toWorld(...local(event))[0]);
  };
  useLayoutEffect(() => {
    const element = svg.current!;
    // Preact's own listener would be passive, and the page would zoom with the canvas.
    element.addEventListener("wheel", onWheel, { passive: false });
    const onMove = (event: Event) => move(event as PointerEvent, local(event as PointerEvent));
    element.addEventListener(MOVE_EVENT, onMove);
    return () => {
      element.removeEventListener("wheel", onWheel);
      element.removeEventListener(MOVE_EVENT, onMove);
    };
  });
  const { width, height } = size.value;
  const box = canvasBox.value;
  return (
    <svg
      ref={svg}
      class="ed"
      width={width}
      height={height}
      data-tool={spaceHeld.value ? "pan" : tool.value}
      data-dragging={dragging.value ?? undefined}
      role="group"
      aria-label="Side view of the terrain profile with the planned robot poses"
      onPointerDown={onPointerDown}
      onPointerUp={release}
      onPointerCancel={() => cancelGesture()}
      onDblClick={onDblClick}
    >
      <defs>
        <clipPath id="canvas-clip">
          <rect
            x={box.left}
            y={box.top}
            width={Math.max(0, box.right - box.left)}
            height={box.bottom - box.top}
          />
        </clipPath>
        <pattern
          id="hatch-bad"
          width="6"
          height="6"
          patternUnits="userSpaceOnUse"
          patternTransform="rotate(45)"
        >
          <rect width="6" height="6" class="hb" />
          <rect width="2.5" height="6" class="hs" />
        </pattern>
        <pattern
          id="hatch"
          width="8"
          height="8"
          patternUnits="userSpaceOnUse"
          patternTransform="rotate(45)"
        >
          <rect width="1" height="8" class="ghs" />
        </pattern>
        <RibbonPatterns />
        <linearGradient id="ground" x1="0" y1="0" x2="0" y2="1">
          <stop offset="0" class="ts0" />
          <stop offset="1" class="ts1" />
        </linearGradient>
      </defs>
      <g clip-path="url(#canvas-clip)">
        <Grid />
        <Ground />
        <WheelPath />
        <SpeedRibbon />
        <Ghosts />
        <Stretches />
        <Current />
        <KeyNumbers />
        <Dimensions />
        <Guides />
        <Vertices />
      </g>
      <Rulers />
    </svg>
  );
}

export function Editor() {
  const holder = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => {
    const element = holder.current!;
    const measure = () => {
      const first = size.peek().width === 0;
      const { clientWidth, clientHeight } = element;
      if (clientWidth === 0) return;
      size.value = { width: clientWidth, height: clientHeight };
      if (first || !moved.peek()) fit(drawing.peek().points);
    };
    measure();
    // Another robot may need more room; a view that was chosen by hand stays.
    const stops = [
      robotName.subscribe(() => {
        if (size.peek().width > 0 && !moved.peek()) fit(drawing.peek().points);
      }),
      // Who draws corner by corner means the place that the pen is at.
      committed.subscribe(({ points }) => tool.peek() === "select" && refit(points)),
    ];
    const observer = new ResizeObserver(measure);
    observer.observe(element);
    return () => {
      for (const stop of stops) stop();
      observer.disconnect();
    };
  }, []);
  return (
    <section
      class="edit"
      data-panel="editor"
      aria-label="Profile editor"
      data-faded={outdated.value ? "" : undefined}
      data-preview={preview.value && !outdated.value ? "" : undefined}
    >
      <Toolbar />
      <div class="canvas" ref={holder}>
        <Canvas />
        <Legend />
        <EmptyCanvas />
        <Obstruction />
        <Refusal />
        <Readout />
        <DimensionField />
        <FirstHint />
        <Veil />
        <Banner />
      </div>
    </section>
  );
}
