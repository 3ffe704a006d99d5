/** What a file held: the robot, what had to be assumed, what to know; or why it is none. */

import { useState } from "preact/hooks";
import { Icon } from "../ui/icon";
import { openRead, reading, stopReading } from "./shelf";

/** So many remarks are shown at once; the rest on demand. */
const FIRST = 3;

export function ReadReport() {
  const now = reading.value;
  if (!now) return null;
  const { file, imported, refused } = now;
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
          <button type="button" class="btn pri" onClick={openRead}>
            Open {imported.robot.name}
          </button>
        </>
      )}
    </section>
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
