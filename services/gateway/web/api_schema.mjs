// Writes the types of the gateway's own description: src/api_schema.d.ts, for `npm run check` and for editors.
import openapiTS, { astToString } from "openapi-typescript";
import { writeFile } from "node:fs/promises";

const described = new URL("../openapi.json", import.meta.url);
const types = await openapiTS(described, { defaultNonNullable: false });
await writeFile(new URL("src/api_schema.d.ts", import.meta.url), astToString(types));
