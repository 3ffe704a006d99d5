import { fixed } from "../geometry/format";
import { NumberField } from "./number-field";

interface Props {
  label: string;
  value: number;
  min?: number;
  max: number;
  class?: string;
  onChange: (value: number) => void;
}

/** A whole number. */
export const CountField = ({ min = 1, onChange, ...rest }: Props) => (
  <NumberField
    {...rest}
    min={min}
    step={1}
    format={(v) => fixed(v, 0)}
    onChange={(value) => onChange(Math.round(value))}
  />
);
