/** Why nothing was imported, shown where the import was. */

import { Icon } from "../ui/icon";
import { importProblem, type Place } from "./take";

export function ImportProblem({ place }: { place: Place }) {
  const problem = importProblem.value;
  if (problem?.place !== place) return null;
  return (
    <div class={place === "page" ? "import-error tag" : "import-error"} role="alert">
      <Icon name="warning" />
      <span>{problem.text}</span>
      <button
        type="button"
        class="t ico"
        aria-label="Dismiss"
        onClick={() => {
          importProblem.value = null;
        }}
      >
        <Icon name="close" />
      </button>
    </div>
  );
}
