/** The name that something is saved under, as the service takes it. */

interface Props {
  value: string;
  onChange: (name: string) => void;
}

export function NameField({ value, onChange }: Props) {
  return (
    <label>
      <span>Save as</span>
      <input
        value={value}
        maxLength={100}
        required
        pattern="[\w .+\-]*\w[\w .+\-]*"
        title="A letter or digit at least; besides those space and . + - _"
        onInput={(event) => onChange(event.currentTarget.value)}
      />
    </label>
  );
}
