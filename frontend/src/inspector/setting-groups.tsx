/** Settings under their headings; one that is closed says whether anything in it was changed. */

import type { SettingChange, SettingSchema, SettingValues } from "../api/types";
import { kept } from "../state/kept";
import { withValue } from "../state/setup";
import { Icon } from "../ui/icon";
import { SettingRow } from "./setting-row";

type Schemas = Record<string, SettingSchema>;

interface GroupsProps {
  schemas: Schemas;
  values: SettingValues;
  /** What a group is called in which nothing was changed. */
  unchanged: string;
  onChange: (name: string, value: SettingChange) => void;
}

/** Names of those that are closed, one a line. */
const closed = kept("closed-groups", "", (text) => text);
const names = () => closed.value.split("\n").filter(Boolean);

function toggle(group: string): void {
  const now = names();
  const next = now.includes(group) ? now.filter((each) => each !== group) : [...now, group];
  closed.value = next.join("\n");
}

function byGroup(schemas: Schemas): Map<string, [string, SettingSchema][]> {
  const groups = new Map<string, [string, SettingSchema][]>();
  for (const entry of Object.entries(schemas)) {
    const group = entry[1].group ?? "";
    groups.set(group, [...(groups.get(group) ?? []), entry]);
  }
  return groups;
}

export function SettingGroups({ schemas, values, unchanged, onChange }: GroupsProps) {
  return (
    <>
      {[...byGroup(schemas)].map(([group, members]) => {
        const open = !names().includes(group);
        const changed = members.filter(([name]) => name in values).length;
        return [
          <button
            key={group}
            type="button"
            class="group"
            aria-expanded={open}
            onClick={() => toggle(group)}
          >
            <Icon name="down" turn={!open} />
            {group}
            <small>{changed > 0 ? `${changed} changed` : unchanged}</small>
          </button>,
          open && members.map(([name, schema]) => <Rows {...{ name, schema, values, onChange }} />),
        ];
      })}
    </>
  );
}

interface RowsProps extends Pick<GroupsProps, "values" | "onChange"> {
  name: string;
  schema: SettingSchema;
}

/** Of one setting; of a record a row for each of its fields. */
function Rows({ name, schema, values, onChange }: RowsProps) {
  const value = values[name];
  if (!schema.properties) {
    const change = (next: SettingChange) => onChange(name, next);
    return <SettingRow name={name} schema={schema} value={value} onChange={change} />;
  }
  const fields = (value ?? {}) as SettingValues;
  return (
    <>
      {Object.entries(schema.properties).map(([field, part]) => (
        <SettingRow
          key={field}
          name={field}
          schema={part}
          value={fields[field]}
          onChange={(next) => {
            const record = withValue(fields, part, field, next);
            onChange(name, Object.keys(record).length > 0 ? record : null);
          }}
        />
      ))}
    </>
  );
}
