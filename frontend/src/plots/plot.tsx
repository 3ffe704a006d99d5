/** A panel on screen: header with the values at the clock, chart, cursor, zoom. */

import { type ReadonlySignal, useComputed, useSignalEffect } from "@preact/signals";
import { useLayoutEffect, useRef } from "preact/hooks";
import { fixed } from "../geometry/format";
import { interpolate } from "../geometry/frames";
import { plan } from "../state/planning";
import { duration, hoverTime, playing, seek, shownTime } from "../state/playback";
import { theme } from "../state/view";
import { Icon } from "../ui/icon";
import { Chart, LEFT, RIGHT, type Tint } from "./chart";
import type { Panel } from "./lines";
import { palette } from "./palette";
import { SaveMenu, TableMenu } from "./plot-menus";
import { alonePlot } from "./room";
import { timeWindow, zoomTime } from "./window";

interface PlotProps {
  panel: ReadonlySignal<Panel>;
  tint: ReadonlySignal<Tint | null>;
}

/** Bands and lines are laid out once; another layout needs another chart. */
const layoutOf = (panel: Panel) =>
  panel.halves.map((h) => h.map((l) => l.kind + l.color).join()).join("/");

export function Plot({ panel, tint }: PlotProps) {
  const holder = useRef<HTMLDivElement>(null);
  const chart = useRef<{ chart: Chart; layout: string } | null>(null);
  const layout = useComputed(() => layoutOf(panel.value)).value;
  const shade = theme.value;
  // These are the same for all that a plot may show.
  const { id, title, unit } = panel.peek();
  const alone = alonePlot.value === id;

  useLayoutEffect(() => {
    const element = holder.current!;
    const { clientWidth: w, clientHeight: h } = element;
    const state = { panel: panel.peek(), window: timeWindow.peek(), tint: tint.peek() };
    const made = new Chart(element, w, h, state, palette());
    chart.current = { chart: made, layout };
    const observer = new ResizeObserver(() =>
      made.resize(element.clientWidth, element.clientHeight),
    );
    observer.observe(element);
    return () => {
      observer.disconnect();
      made.destroy();
      chart.current = null;
    };
  }, [layout, shade]);

  // What is drawn changes with every answer; the elements around it do not.
  useSignalEffect(() => {
    const state = { panel: panel.value, window: timeWindow.value, tint: tint.value };
    // Another layout gets another chart, which begins with what there is then.
    if (chart.current?.layout === layoutOf(state.panel)) chart.current.chart.update(state);
  });

  return (
    <section class="plot" aria-label={title}>
      <header>
        <h3>
          {title}
          {unit !== "%" && <small>{unit}</small>}
        </h3>
        <Values panel={panel} />
        <span class="plot-tools">
          <SaveMenu panel={panel} />
          <TableMenu panel={panel} />
          <button
            type="button"
            class="t ico"
            aria-label={alone ? "Show all plots" : `Maximise ${title}`}
            title={alone ? "Show all plots (Escape)" : `Maximise ${title}`}
            aria-pressed={alone}
            onClick={() => {
              alonePlot.value = alone ? null : id;
            }}
          >
            <Icon name={alone ? "restore" : "maximise"} />
          </button>
        </span>
      </header>
      <Surface>
        <div class="chart" ref={holder} aria-hidden="true" />
        <TimeCursor />
      </Surface>
    </section>
  );
}

/** Numbers at the clock, in the colours of their lines. */
function Values({ panel }: { panel: ReadonlySignal<Panel> }) {
  const t = shownTime.value;
  const { halves, time } = panel.value;
  const lines = halves.flat().filter((line) => line.read);
  return (
    <div class="vals" aria-hidden="true">
      {lines.map((line) => {
        const value = interpolate(time, line.raw ?? line.values, t);
        return (
          <span key={line.label} class={`v ${line.color}`}>
            <i />
            {line.read!.name}
            <b>{fixed(value, line.read!.digits)}</b>
            {line.read!.unit}
          </span>
        );
      })}
    </div>
  );
}

function TimeCursor() {
  const left = useComputed(() => {
    const [from, to] = timeWindow.value;
    return (shownTime.value - from) / (to - from);
  });
  const share = left.value;
  if (!(share >= 0 && share <= 1) || duration.value <= 0) return null;
  const bad = plan.value?.problem && shownTime.value >= duration.value - 1e-6;
  return (
    <div
      class={bad ? "tcur bad" : "tcur"}
      style={{ left: `calc(${LEFT}px + (100% - ${LEFT + RIGHT}px) * ${share.toFixed(5)})` }}
    />
  );
}

/** Pointer on a plot: hover previews, a drag sets the time, Shift-drag zooms, the wheel zooms too. */
function Surface({ children }: { children: preact.ComponentChildren }) {
  const root = useRef<HTMLDivElement>(null);
  const band = useRef<HTMLDivElement>(null);
  const zoomFrom = useRef<number | null>(null);
  const timeAt = (event: MouseEvent) => {
    const rect = root.current!.getBoundingClientRect();
    const share = (event.clientX - rect.left - LEFT) / (rect.width - LEFT - RIGHT);
    const [from, to] = timeWindow.peek();
    return from + Math.min(1, Math.max(0, share)) * (to - from);
  };
  const onPointerDown = (event: PointerEvent) => {
    if (event.button !== 0) return;
    root.current!.setPointerCapture(event.pointerId);
    if (event.shiftKey) {
      zoomFrom.current = timeAt(event);
      return;
    }
    playing.value = false;
    hoverTime.value = null;
    seek(timeAt(event));
  };
  const onPointerMove = (event: PointerEvent) => {
    const t = timeAt(event);
    if (zoomFrom.current !== null) showBand(zoomFrom.current, t);
    else if (event.buttons === 1) seek(t);
    else if (!playing.peek() && event.pointerType === "mouse")
      hoverTime.value = Math.min(t, duration.peek());
  };
  const showBand = (a: number, b: number) => {
    const rect = root.current!.getBoundingClientRect();
    const [from, to] = timeWindow.peek();
    const px = (t: number) => LEFT + ((t - from) / (to - from)) * (rect.width - LEFT - RIGHT);
    Object.assign(band.current!.style, {
      left: `${px(Math.min(a, b))}px`,
      width: `${Math.abs(px(a) - px(b))}px`,
    });
  };
  const onPointerUp = (event: PointerEvent) => {
    if (zoomFrom.current === null) return;
    const [a, b] = [zoomFrom.current, timeAt(event)].sort((p, q) => p - q) as [number, number];
    zoomFrom.current = null;
    band.current!.style.width = "0";
    if (b - a > 0.02) timeWindow.value = [a, b];
  };
  useLayoutEffect(() => {
    const element = root.current!;
    const onWheel = (event: WheelEvent) => {
      event.preventDefault();
      zoomTime(timeAt(event), Math.exp(event.deltaY * 0.0015));
    };
    element.addEventListener("wheel", onWheel, { passive: false });
    return () => element.removeEventListener("wheel", onWheel);
  });
  return (
    // biome-ignore lint/a11y/noStaticElementInteractions: the transport is the same for the keyboard
    <div
      class="surface"
      ref={root}
      title="Click sets the time; wheel or Shift-drag zooms; double click shows all"
      onPointerDown={onPointerDown}
      onPointerMove={onPointerMove}
      onPointerUp={onPointerUp}
      onPointerLeave={() => {
        hoverTime.value = null;
      }}
      onDblClick={() => zoomTime(0, Number.POSITIVE_INFINITY)}
    >
      {children}
      <div class="zoomband" ref={band} />
    </div>
  );
}
