/** Overlaid results driving together: CoM paths and a ghost of each on one timeline. */

import { useEffect, useState } from "preact/hooks";
import type { Vec2 } from "../api/types";
import { fixed } from "../geometry/format";
import { skeleton } from "../geometry/robot";
import { Icon } from "../ui/icon";
import { pen } from "./lines";
import { letter } from "./pins";
import type { Track } from "./tracks";

/** A result on its place among the pins. */
interface Shown {
  place: number;
  track: Track;
}

/** A page that was hidden does not leap [s]. */
const LONGEST_FRAME = 1;
/** Room for the robot above and beside its centre of mass [m]. */
const ROOM = 0.3;

/** Height of a letter, which stands over its robot, above those of the pins before [m]. */
const LETTER = 0.07;

const chain = (points: readonly Vec2[]) =>
  points.map((p) => `${p[0].toFixed(4)},${(-p[1]).toFixed(4)}`).join(" ");

export function Replay({ all }: { all: readonly Shown[] }) {
  const end = Math.max(0, ...all.map(({ track }) => track.time.at(-1) ?? 0));
  const [time, setTime] = useState(0);
  const [playing, setPlaying] = useState(false);
  useEffect(() => {
    if (!playing) return;
    let last = performance.now();
    let at = time >= end - 1e-6 ? 0 : time;
    let next = 0;
    const tick = (now: number) => {
      at = Math.min(end, at + Math.min(LONGEST_FRAME, (now - last) / 1000));
      last = now;
      setTime(at);
      if (at >= end) setPlaying(false);
      else next = requestAnimationFrame(tick);
    };
    next = requestAnimationFrame(tick);
    return () => cancelAnimationFrame(next);
  }, [playing, end]);
  if (all.length === 0) return null;
  const now = Math.min(time, end);
  return (
    <section class="ovl" aria-label="Replay">
      <h3>
        CoM paths and replay <small>x and z to one scale</small>
      </h3>
      <Side all={all} time={now} />
      <div class="ovl-clock">
        <button
          type="button"
          class="t ico"
          aria-label={playing ? "Pause the replay" : "Play together"}
          title={playing ? "Pause the replay" : "Play together"}
          onClick={() => setPlaying(!playing)}
        >
          <Icon name={playing ? "pause" : "play"} fill={!playing} />
        </button>
        <input
          type="range"
          min={0}
          max={end}
          step={0.01}
          value={now}
          aria-label="Time of the replay"
          aria-valuetext={`${fixed(now, 2)} s of ${fixed(end, 2)} s`}
          onInput={(event) => {
            setPlaying(false);
            setTime(Number(event.currentTarget.value));
          }}
        />
        <span>
          {fixed(now, 2)} / {fixed(end, 2)} s
        </span>
      </div>
    </section>
  );
}

function Side({ all, time }: { all: readonly Shown[]; time: number }) {
  const body = all.flatMap(({ track }) => track.com);
  if (body.length === 0) return null;
  const terrains = new Map(all.map(({ track }) => [chain(track.terrain), track.terrain]));
  const x0 = Math.min(...body.map((p) => p[0])) - 1.5 * ROOM;
  const x1 = Math.max(...body.map((p) => p[0])) + 1.5 * ROOM;
  const near = [...terrains.values()].flat().filter((p) => p[0] >= x0 && p[0] <= x1);
  const z0 = Math.min(...body.map((p) => p[1]), ...near.map((p) => p[1])) - 0.05;
  const z1 = Math.max(...body.map((p) => p[1])) + ROOM;
  return (
    <svg
      class="ovl-paths"
      viewBox={`${x0} ${-z1} ${x1 - x0} ${z1 - z0}`}
      role="img"
      aria-label={`CoM paths and poses of ${all.map(({ place }) => letter(place)).join(", ")}`}
    >
      {[...terrains.keys()].map((points) => (
        <polyline key={points} class="profile" points={points} />
      ))}
      {all.map(({ place, track }) => (
        <polyline
          key={place}
          class="ovl-com"
          data-pin={letter(place)}
          points={chain(track.com)}
          style={pen(place)}
        />
      ))}
      {all.map((shown) => (
        <Ghost key={shown.place} shown={shown} time={time} />
      ))}
    </svg>
  );
}

/** The robot of one result at a time; after its end it stands where it ended. */
function Ghost({ shown: { place, track }, time }: { shown: Shown; time: number }) {
  const frame = track.frameAt(Math.min(time, track.time.at(-1) ?? 0));
  if (!frame || !track.shape) return null;
  const bones = skeleton(track.shape, frame);
  return (
    <g class="ovl-ghost" data-ghost={letter(place)} style={pen(place)}>
      <polygon points={chain(bones.trunk)} />
      {bones.legs.map((joints, k) => (
        <g key={k}>
          <polyline points={chain(joints)} />
          <circle cx={joints[2]![0]} cy={-joints[2]![1]} r={track.shape!.wheel} />
        </g>
      ))}
      <text
        x={frame.x}
        y={-frame.z - LETTER * (1.6 + place)}
        font-size={LETTER}
        text-anchor="middle"
      >
        {letter(place)}
      </text>
    </g>
  );
}
