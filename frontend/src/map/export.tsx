/** The map as a picture, and the study as files for other tools. */

import { Icon } from "../ui/icon";
import { Menu, MenuItem } from "../ui/menu";
import { inkOf } from "./palette";
import { saveAs } from "./save";
import { paint, toSvg } from "./shapes";
import { study } from "./state";
import { studyExport } from "./studies";
import { frameFor, pictureFor } from "./view";

const SIZE = [1200, 860] as const;
/** Pixels of the PNG to one of the picture: sharp in print. */
const RATIO = 2;

function picture() {
  const frame = frameFor(...SIZE);
  const room = document.querySelector(".map-room");
  return frame && room && pictureFor(frame, inkOf(room));
}

function saveSvg(name: string): void {
  const drawn = picture();
  if (drawn) saveAs(new Blob([toSvg(drawn, name)], { type: "image/svg+xml" }), `${name}.svg`);
}

function savePng(name: string): void {
  const drawn = picture();
  if (!drawn) return;
  const canvas = document.createElement("canvas");
  canvas.width = drawn.width * RATIO;
  canvas.height = drawn.height * RATIO;
  const context = canvas.getContext("2d")!;
  context.setTransform(RATIO, 0, 0, RATIO, 0, 0);
  context.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--bg1");
  context.fillRect(0, 0, drawn.width, drawn.height);
  paint(context, drawn);
  canvas.toBlob((blob) => blob && saveAs(blob, `${name}.png`));
}

const FILES = [
  ["netcdf", "NetCDF", "all axes, for xarray"],
  ["csv", "CSV", "one cell a row"],
] as const;

export function ExportMenu() {
  const id = study.value!.id;
  const name = `map-${id}`;
  const button = (
    <>
      <Icon name="download" />
      Export
      <Icon name="down" />
    </>
  );
  return (
    <Menu label="Export" named button={button} buttonClass="t" align="right" panelClass="downloads">
      {(close) => (
        <>
          <MenuItem
            onChoose={() => {
              savePng(name);
              close();
            }}
          >
            <b>PNG</b>
            <small>this view</small>
          </MenuItem>
          <MenuItem
            onChoose={() => {
              saveSvg(name);
              close();
            }}
          >
            <b>SVG</b>
            <small>this view, to edit</small>
          </MenuItem>
          {FILES.map(([format, title, note]) => (
            <a
              key={format}
              class="item"
              role="menuitem"
              tabIndex={-1}
              href={studyExport(id, format)}
              download=""
              onClick={() => setTimeout(close)}
            >
              <b>{title}</b>
              <small>{note}</small>
            </a>
          ))}
          <a
            class="item"
            role="menuitem"
            tabIndex={-1}
            href={`/api/v1/studies/${id}/document`}
            download={`${id}.json`}
            onClick={() => setTimeout(close)}
          >
            <b>JSON</b>
            <small>the study, to run again</small>
          </a>
        </>
      )}
    </Menu>
  );
}
