/** Maps that this service has computed before. */

import { Icon } from "../ui/icon";
import { Menu, MenuItem } from "../ui/menu";
import { earlier, openStudy, readList, title } from "./state";
import { count } from "./work";

export function Earlier() {
  if (earlier.value.length === 0) return null;
  const button = (
    <>
      Earlier
      <Icon name="down" />
    </>
  );
  return (
    <div onPointerDownCapture={() => void readList()}>
      <Menu label="Earlier maps" named button={button} buttonClass="t" align="right">
        {(close) =>
          earlier.value.map((each) => (
            <MenuItem
              key={each.id}
              onChoose={() => {
                void openStudy(each.id);
                close();
              }}
            >
              <span class="two">
                {title(each)}
                <small>
                  {count(each.done)} cells, {each.state === "cancelled" ? "paused" : each.state},{" "}
                  {new Date(each.created * 1000).toLocaleString("en-GB", {
                    dateStyle: "medium",
                    timeStyle: "short",
                  })}
                </small>
              </span>
            </MenuItem>
          ))
        }
      </Menu>
    </div>
  );
}
