// Whether the browser draws in space.

import { make } from "../page";

// Why not, in words; empty: it does.
export function why_no_space(): string {
  let detail = "";
  const canvas = make("canvas");
  canvas.addEventListener("webglcontextcreationerror", (event) => {
    detail = (event as WebGLContextEvent).statusMessage;
  });
  const context = canvas.getContext("webgl2");
  if (context) {
    context.getExtension("WEBGL_lose_context")?.loseContext(); // browsers allow only a few
    return "";
  }
  return no_space_text(detail);
}

// Of a browser that says how it has tried, in lines, the code of the failure is kept, or its first line.
export function no_space_text(detail: string): string {
  const code = /FEATURE_\w+/.exec(detail)?.[0];
  const words = code ?? detail.split("\n")[0]!.trim().replace(/[.:]$/, "");
  const cause = words === "" ? "" : ` (${words})`;
  return `No 3-D picture: this browser offers no WebGL 2${cause}.`;
}
