// Packs each named file with brotli, as well as it can: FILE becomes FILE.br.
//
//     node brotli.mjs FILE...
import fs from 'node:fs';
import zlib from 'node:zlib';

const {BROTLI_PARAM_QUALITY, BROTLI_PARAM_SIZE_HINT, BROTLI_MAX_QUALITY} = zlib.constants;
for (const file of process.argv.slice(2)) {
  const bytes = fs.readFileSync(file);
  fs.writeFileSync(`${file}.br`, zlib.brotliCompressSync(bytes,
      {params: {[BROTLI_PARAM_QUALITY]: BROTLI_MAX_QUALITY, [BROTLI_PARAM_SIZE_HINT]: bytes.length}}));
}
