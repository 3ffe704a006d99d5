/** Every export of the profile, of the plan and of the rollout. */

import { call, exportPath, exportUrl, reasonOf } from "../api/client";
import type { ExportFormat, Plan } from "../api/types";
import { report } from "../state/connection";
import { drawing, isEmpty, terrainDocument } from "../state/drawing";
import { plan } from "../state/planning";
import { run, runOf, runPlan } from "../state/rollouts";
import { robotName, settings } from "../state/setup";
import { toast } from "../state/toast";
import { isNarrow } from "../state/view";
import { Icon } from "../ui/icon";
import { Menu } from "../ui/menu";
import { saveFile } from "../ui/save-file";

export function DownloadMenu() {
  const button = (
    <>
      <Icon name="download" />
      {!isNarrow.value && (
        <>
          <span class="dl-text">Download</span>
          <span class="wide">
            <Icon name="down" />
          </span>
        </>
      )}
    </>
  );
  return (
    <Menu
      label="Download"
      button={button}
      buttonClass={isNarrow.value ? "btn sq" : "btn"}
      panelClass="downloads"
      align="right"
      disabled={isEmpty.value && !run.value}
    >
      {(close) => <Everything close={close} />}
    </Menu>
  );
}

function Everything({ close }: { close: () => void }) {
  const shown = plan.value;
  const result = run.value;
  const formats = settings.value?.exports;
  return (
    <>
      {!isEmpty.value && <Profile close={close} />}
      {shown && (
        <Exports
          title="Plan"
          kind="plans"
          id={shown.id}
          formats={(formats?.plan ?? []).filter((format) => isOf(format, shown))}
          close={close}
        />
      )}
      {result ? (
        <Exports
          title={runOf.value ? `Rollout of the ${runOf.value}` : "Rollout"}
          kind="rollouts"
          id={result.id}
          formats={formats?.rollout ?? []}
          close={close}
        />
      ) : (
        <div class="note">Run a rollout to download its series and replay.</div>
      )}
    </>
  );
}

/** A bundle is for a robot to follow: there is none of a plan that ends before the goal. */
const isOf = (format: ExportFormat, { status }: Plan) =>
  status === "feasible" || format.name !== "bundle";

/** The drawing itself: what is dropped here or given to the command line opens it again. */
function Profile({ close }: { close: () => void }) {
  const document = terrainDocument(drawing.value);
  const text = encodeURIComponent(JSON.stringify(document, null, 2));
  return (
    <>
      <div class="head">Profile</div>
      <a
        class="item"
        role="menuitem"
        tabIndex={-1}
        href={`data:application/json,${text}`}
        download={`${document.name}.json`}
        onClick={() => setTimeout(close)}
      >
        <b>JSON</b>
        <small>{document.schema}</small>
      </a>
    </>
  );
}

/** Terrain and robot, as people look for a file. */
function fileName(kind: "plans" | "rollouts"): string {
  const of = kind === "plans" ? plan.peek() : runPlan.peek();
  const terrain = of?.terrain.name ?? drawing.peek().name;
  return `${terrain}-${of?.robot ?? robotName.peek()}-${kind.slice(0, -1)}`;
}

/** Download an export under that name, with the ending that the service gives it. */
async function saveExport(path: string, name: string): Promise<void> {
  try {
    const answer = await call("GET", path);
    const given = /filename="[^"]*?((?:\.[a-z0-9]+)+)"/i;
    const ending = given.exec(answer.headers.get("content-disposition") ?? "")?.[1] ?? "";
    saveFile(name + ending, await answer.blob());
  } catch (error) {
    report(error);
    toast.value = { text: `Not downloaded: ${reasonOf(error)}` };
  }
}

interface ExportsProps {
  title: string;
  kind: "plans" | "rollouts";
  id: string;
  formats: ExportFormat[];
  close: () => void;
}

function Exports({ title, kind, id, formats, close }: ExportsProps) {
  return (
    <>
      <div class="head">{title}</div>
      {formats.map(({ name, note }) => (
        <a
          key={name}
          class="item"
          role="menuitem"
          tabIndex={-1}
          href={exportUrl(kind, id, name)}
          download=""
          onClick={(event) => {
            event.preventDefault();
            void saveExport(exportPath(kind, id, name), fileName(kind));
            close();
          }}
        >
          <b>{name.toUpperCase()}</b>
          <small>{note}</small>
        </a>
      ))}
    </>
  );
}
