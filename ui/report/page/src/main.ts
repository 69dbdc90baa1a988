// Entry of the report's page.
import { decompress } from "fzstd";
import uPlot from "uplot";
import * as THREE from "three";
console.debug(decompress, uPlot, THREE.WebGLRenderer);
