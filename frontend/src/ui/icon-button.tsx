/** A button of the bars that shows only an icon; its label is its tooltip and what is read out. */

import { Icon, type IconName } from "./icon";

interface Props {
  action: () => void;
  label: string;
  icon: IconName;
  off: boolean;
  fill?: boolean;
}

export function IconButton({ action, label, icon, off, fill }: Props) {
  return (
    <button
      type="button"
      class="t ico"
      aria-label={label}
      title={label}
      disabled={off}
      onClick={action}
    >
      <Icon name={icon} fill={fill} />
    </button>
  );
}
