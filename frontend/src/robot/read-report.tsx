/** What a file held: the robot, what had to be assumed, what to know; or why it is none. */

import { useState } from "preact/hooks";
import { Icon } from "../ui/icon";
import { openRead, type Reading, readFile, reading, stopReading } from "./shelf";

/** So many remarks are shown at once; the rest on demand. */
const FIRST = 3;

export function ReadReport() {
  const now = reading.value;
  if (!now) return null;
  const { imported, refused } = now;
  const file = now.file.name;
  return (
    <section class="read-report" aria-label="File" aria-live="polite">
      <button type="button" class="t ico" aria-label="Dismiss" onClick={stopReading}>
        <Icon name="close" />
      </button>
      {!imported && !refused && (
        <p>
          <span class="spin" />
          <span>
            Reading <b>{file}</b>
          </span>
        </p>
      )}
      {refused && (
        <p class="error" role="alert">
          <Icon name="warning" />
          <span>
            <b>{file}</b> does not fit. {refused}
          </span>
        </p>
      )}
      {imported && (
        <>
          <p>
            <Icon name="check" />
            <span>
              <b>{file}</b> read: {imported.robot.name}
            </span>
          </p>
          <Remarks key={`w${file}`} title="to know" texts={imported.warnings} />
          <Remarks key={`a${file}`} title="assumed" texts={imported.assumed} />
        </>
      )}
      {hasOthers(now) && <Hold key={file} now={now} />}
      {imported && (
        <button type="button" class="btn pri" onClick={openRead}>
          Open {imported.robot.name}
        </button>
      )}
    </section>
  );
}

/** Whether the file has joints that a robot of ours has not. */
function hasOthers({ hold, imported, refused }: Reading): boolean {
  if (imported) return Object.keys(imported.locked).length > 0;
  return Boolean(hold) || /\bhold\b/.test(refused ?? "");
}

/** Which joints count as rigid, and where: an arm that is folded, an ankle that is one too many. */
function Hold({ now }: { now: Reading }) {
  const [typed, setTyped] = useState(now.hold);
  return (
    <form
      class="hold"
      onSubmit={(event) => {
        event.preventDefault();
        void readFile(now.file, typed);
      }}
    >
      <label>
        <span>Hold joints rigid [rad]</span>
        <input
          value={typed}
          placeholder="arm_joint=0.5, wrist=0"
          title="The file's joints and angles, with commas between them"
          spellcheck={false}
          autocomplete="off"
          onInput={(event) => setTyped(event.currentTarget.value)}
        />
      </label>
      <button type="submit" class="t" disabled={typed === now.hold}>
        Read again
      </button>
    </form>
  );
}

function Remarks({ title, texts }: { title: string; texts: string[] }) {
  const [all, setAll] = useState(false);
  if (texts.length === 0) return null;
  const shown = all ? texts : texts.slice(0, FIRST);
  return (
    <>
      <h3>
        {texts.length} {title}
      </h3>
      <ul>
        {shown.map((text) => (
          <li key={text}>{text}</li>
        ))}
      </ul>
      {texts.length > shown.length && (
        <button type="button" class="more" onClick={() => setAll(true)}>
          {texts.length - shown.length} more
        </button>
      )}
    </>
  );
}
