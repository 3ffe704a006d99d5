/** On the right: what building codes ask for and the robot climbs, and the cell that is kept. */

import { fixed } from "../geometry/format";
import { PLANNED } from "../results/figures";
import { Icon } from "../ui/icon";
import { Facts } from "./card";
import { type CellFacts, factsAt, frictionAt } from "./cell";
import { CODES } from "./codes";
import type { Place } from "./frame";
import { KeptFigure, useCell } from "./kept-figure";
import { openCell } from "./open-cell";
import { share } from "./share-climbed";
import { fields, layout, robotAxis } from "./state";
import { options, pinned, shownAxes, showsCodes } from "./view";

export function CellPanel() {
  return (
    <aside class="map-side right" aria-label="Cell">
      <div class="scroll">
        {showsCodes.value && fields.value.length > 0 && <Codes />}
        <Pinned />
      </div>
    </aside>
  );
}

function Codes() {
  const axes = shownAxes.value!;
  const names = robotAxis.value?.values.map(String) ?? [""];
  const friction = frictionAt();
  const searched = layout.value?.boundary !== null;
  return (
    <section>
      <h2>Building codes</h2>
      {names.map((name, robot) => (
        <table key={name} class="codes">
          {name && <caption>{name}</caption>}
          <thead>
            <tr>
              <th scope="col">code</th>
              <th scope="col">climbs</th>
              <th scope="col">needs μ</th>
              {!searched && <th scope="col">CoM, mm</th>}
            </tr>
          </thead>
          <tbody>
            {CODES.filter((code) => options.value.codes.has(code.name)).map((code) => {
              const climbed = share(code, robot, axes[0].values, axes[1].values);
              return (
                <tr key={code.name}>
                  <th scope="row" title={code.note}>
                    {code.name}
                  </th>
                  <td>{climbed.asked ? `${fixed(climbed.percent, 0)} %` : "–"}</td>
                  <td>{fixed(climbed.friction, 2)}</td>
                  {!searched && <td>{fixed(climbed.com * 1000, 0)}</td>}
                </tr>
              );
            })}
          </tbody>
        </table>
      ))}
      <p class="sub">
        Share of each code’s stairs on this map that the robot climbs
        {friction === null ? "" : ` at μ ${fixed(friction, 2)}`}, and the worst of those it climbs.
      </p>
    </section>
  );
}

function Pinned() {
  const place = pinned.value;
  const facts = place && factsAt(place);
  if (!facts || !place) {
    return (
      <section>
        <h2>Kept cell</h2>
        <p class="sub">Shift-click a cell, or press Space on it, to keep it here.</p>
      </section>
    );
  }
  return <Kept place={place} facts={facts} />;
}

function Kept({ place, facts }: { place: Place; facts: CellFacts }) {
  const shown = useCell(facts.cell);
  const plan = facts.both.length === 0 && shown ? shown.plan : null;
  // Studies do not hold the work of their plans: it would take them a third longer.
  const work = typeof plan?.energy === "number" ? PLANNED : [];
  const rows = work.map(({ title, of }) => ({
    name: `${title}, planned`,
    value: of(plan),
    unit: "",
  }));
  return (
    <section class="kept">
      <header>
        <h2>Kept cell</h2>
        <button
          type="button"
          class="t ico"
          aria-label="Deselect the cell"
          onClick={() => {
            pinned.value = null;
          }}
        >
          <Icon name="close" />
        </button>
      </header>
      <KeptFigure shown={shown} />
      <Facts facts={{ ...facts, rows: [...facts.rows, ...rows] }} />
      <button type="button" class="btn pri" onClick={() => void openCell(place)}>
        Open as plan
      </button>
    </section>
  );
}
