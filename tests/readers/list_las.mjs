// Lists a LAS file as copc and as @loaders.gl/las' LAZRsLoader read it: the number of points, bounds, the
// text of the coordinate system, and of some points place, time, ring, source and intensity.
import { readFileSync } from "node:fs";
import { parse } from "@loaders.gl/core";
import { LAZRsLoader } from "@loaders.gl/las";
import { Las } from "copc";

const bytes = readFileSync(process.argv[2]);
const header = Las.Header.parse(bytes.subarray(0, 375));
const get = async (begin, end) => bytes.subarray(begin, end);
const record = Las.Vlr.find(await Las.Vlr.walk(get, header), "LASF_Projection", 2112);
console.log("copc", header.pointCount, ...header.min, ...header.max);
console.log((await Las.Vlr.fetch(get, record)).toString().replace(/\0$/, ""));
const view = Las.View.create(bytes.subarray(header.pointDataOffset), header);
const fields = ["X", "Y", "Z", "GpsTime", "UserData", "PointSourceId", "Intensity"];
const getters = fields.map((field) => view.getter(field));
for (const k of [0, header.pointCount - 1]) console.log(...getters.map((value) => value(k)));

// The loader asks for its WebAssembly by a file's address, which Node's fetch does not know.
globalThis.fetch = async (address) =>
  new Response(readFileSync(address), { headers: { "content-type": "application/wasm" } });
const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
const mesh = await parse(buffer, LAZRsLoader, { las: { fp64: true } });
const places = mesh.attributes.POSITION.value;
console.log("laz-rs", mesh.header.vertexCount, ...places.slice(0, 3), ...places.slice(-3));
