/** The name that something is saved under, as the service takes it. */

/** Of any alphabet, as the service has it. */
const LETTER = "\\p{Alphabetic}\\p{M}\\p{Nd}_";

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
        pattern={`[${LETTER} .+\\-]*[${LETTER}][${LETTER} .+\\-]*`}
        title="A letter or digit at least; besides those space and . + - _"
        onInput={(event) => onChange(event.currentTarget.value)}
      />
    </label>
  );
}
