// compare_tables.mjs A.tsv B.tsv: the same rows? Numbers to 1e-9 of the greatest in their column.

import fs from 'node:fs';

const [a, b] = process.argv.slice(2, 4).map((file) => fs.readFileSync(file, 'utf8').trimEnd().split('\n').map((line) => line.split('\t')));
const fail = (text) => {
    console.error(text);
    process.exit(1);
};
if (a.length !== b.length || a.length < 100) fail(`${a.length} rows and ${b.length} rows`);
if (a[0].join() !== b[0].join()) fail('other columns');
let worst = 0;
let where = '';
a[0].forEach((column, c) => {
    const greatest = Math.max(...a.slice(1).map((row) => Math.abs(Number(row[c])) || 0));
    for (let r = 1; r < a.length; ++r) {
        const [left, right] = [a[r][c], b[r][c]];
        if (left === right) continue;
        const off = Math.abs(Number(left) - Number(right)) / greatest;
        if (!(off <= 1e-9)) fail(`row ${r}, ${column}: ${left} and ${right}`);
        if (off > worst) [worst, where] = [off, `${column}, row ${r}`];
    }
});
console.log(`${a.length - 1} rows alike${worst > 0 ? `; greatest difference ${worst.toExponential(1)} of its column's greatest value (${where})` : ', to the last digit'}`);
