/** What a cell says: its verdict, and the numbers behind it. */

import { reason } from "../geometry/format";
import { Icon } from "../ui/icon";
import { type CellFacts, factsAt } from "./cell";
import { boxOf, type Frame, type Place } from "./frame";
import { quantityOf } from "./quantities";
import { quantity } from "./state";

const WIDTH = 272;
const GAP = 10;

export function Card({ frame, place }: { frame: Frame; place: Place }) {
  const facts = factsAt(place);
  if (!facts) return null;
  const box = boxOf(frame, place);
  const right = box.x + box.w + GAP + WIDTH < frame.width;
  const left = right ? box.x + box.w + GAP : Math.max(4, box.x - GAP - WIDTH);
  const low = box.y > frame.height / 2;
  const top = low ? undefined : `${Math.max(4, box.y - 24)}px`;
  const bottom = low ? `${Math.max(4, frame.height - box.y - box.h - 24)}px` : undefined;
  return (
    <div class="map-card" style={{ left: `${left}px`, top, bottom, width: `${WIDTH}px` }}>
      <Facts facts={facts} short />
      <p class="sub">Click to open as a plan, Shift-click to keep</p>
    </div>
  );
}

export function Facts({ facts, short }: { facts: CellFacts; short?: boolean }) {
  const coloured = quantityOf(quantity.value).title;
  const keep = short
    ? ["Friction needed", "CoM margin", "Clearance", "What binds", coloured]
    : null;
  const rows = [...facts.both, ...facts.rows.filter((row) => !keep || keep.includes(row.name))];
  return (
    <>
      <h4>
        <span>{facts.title}</span>
        <Verdict facts={facts} />
      </h4>
      {facts.message && <p>{reason(facts.message)}</p>}
      {rows.length > 0 && (
        <dl>
          {rows.map((row) => (
            <div key={row.name}>
              <dt>{row.name}</dt>
              <dd>
                {row.value} <small>{row.unit}</small>
              </dd>
            </div>
          ))}
        </dl>
      )}
      {facts.coarse && facts.verdict !== "pending" && (
        <p class="sub">Of the coarse cell next to it; its own is on its way.</p>
      )}
    </>
  );
}

function Verdict({ facts }: { facts: CellFacts }) {
  if (facts.verdict === "pending") return <span class="vd">not yet</span>;
  if (facts.verdict === "feasible") {
    return (
      <span class="vd ok">
        <Icon name="check" />
        Feasible
      </span>
    );
  }
  return (
    <span class="vd no">
      <Icon name="close" />
      {facts.reason}
    </span>
  );
}
