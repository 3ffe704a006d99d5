/** The workspaces, as links: each has an address and a key. */

import { workspace } from "../state/workspace";
import { openRoom, WORKSPACES } from "../workspaces";

export function WorkspaceTabs() {
  if (WORKSPACES.length < 2) return null;
  return (
    <nav class="spaces" aria-label="Workspaces">
      {WORKSPACES.map(({ name, title }, i) => (
        <a
          key={name}
          href={`#v=${name}`}
          aria-current={openRoom().name === name ? "page" : undefined}
          onClick={(event) => {
            event.preventDefault();
            workspace.value = name;
          }}
        >
          {title}
          <kbd>{i + 1}</kbd>
        </a>
      ))}
    </nav>
  );
}
