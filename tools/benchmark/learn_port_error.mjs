// The size of a plant's model error at its ports (PlantModel::port_error), learnt from campaigns in which
// nothing is missing, and how a size that was learnt on other programs does on the program left out.
//   node tools/benchmark/learn_port_error.mjs                        tables of port_error.csv
//   node tools/benchmark/learn_port_error.mjs HOP PROGRAM=FOLDER…    makes port_error.csv anew: HOP is bin/hop,
//                                                                    FOLDER holds one program's campaigns
// Plants are learnt apart; the plant is read from campaign.toml.
// A campaign's log evidence is that of `hop diagnose --port-errors`; differences of it count, not its value.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';

const kSizes = [0, 0.0025, 0.005, 0.01, 0.02, 0.035];
const file = new URL('port_error.csv', import.meta.url);

function measure(hop, programs) {
  const lines = ['plant,program,campaign,' + kSizes.join(',')];
  for (const program of programs) {
    const [name, folder] = program.split('=');
    if (folder === undefined) throw new Error(`"${program}": write PROGRAM=FOLDER`);
    const campaigns = fs.readdirSync(folder).sort().map((entry) => path.join(folder, entry))
      .filter((entry) => fs.existsSync(path.join(entry, 'campaign.toml')));
    if (campaigns.length === 0) throw new Error(`${folder}: no campaign (a folder with campaign.toml)`);
    campaigns.forEach((campaign, i) => {
      console.error(`${name}: campaign ${i + 1} of ${campaigns.length}`);
      const plant = fs.readFileSync(path.join(campaign, 'campaign.toml'), 'utf8').match(/^plant\s*=\s*"(\w+)"/m)?.[1];
      if (plant === undefined) throw new Error(`${campaign}/campaign.toml: no line plant = "…"`);
      const output = fs.mkdtempSync(path.join(os.tmpdir(), 'port_error_'));
      const words = ['diagnose', campaign, '--output', output, '--json', '--port-errors', kSizes.join(',')];
      const text = execFileSync(hop, words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] });
      const evidence = JSON.parse(text).port_error_evidence.map(({ log_evidence }) => log_evidence.toFixed(1));
      lines.push([plant, name, i + 1, ...evidence].join(','));
      fs.writeFileSync(file, lines.join('\n') + '\n');
    });
  }
}

function read() {
  const [head, ...lines] = fs.readFileSync(file, 'utf8').trim().split('\n').map((line) => line.split(','));
  return { sizes: head.slice(3).map(Number),
    campaigns: lines.map(([plant, program, , ...values]) => ({ plant, program, evidence: values.map(Number) })) };
}

// Summed log evidence of each size.
const summed = (campaigns, count) => Array.from({ length: count }, (_, i) =>
  campaigns.reduce((sum, { evidence }) => sum + evidence[i], 0));
const best = (sums) => sums.indexOf(Math.max(...sums));

function tables({ sizes, campaigns }, plant) {
  const names = [...new Set(campaigns.map(({ program }) => program))];
  const loss = (sums, i) => (Math.max(...sums) - sums[i]).toFixed(0);
  console.log(`${plant}: log evidence lost against the best size\nprogram campaigns ${sizes.join(' ')}`);
  for (const name of [...names, 'all']) {
    const own = campaigns.filter(({ program }) => name === 'all' || program === name);
    const sums = summed(own, sizes.length);
    console.log([name, own.length, ...sums.map((_, i) => loss(sums, i))].join(' '));
  }
  console.log('\nleft out: size learnt on the others, log evidence lost a campaign of the program left out');
  for (const name of names) {
    const learnt = best(summed(campaigns.filter(({ program }) => program !== name), sizes.length));
    const own = campaigns.filter(({ program }) => program === name), sums = summed(own, sizes.length);
    console.log(`${name} ${sizes[learnt]} ${(loss(sums, learnt) / own.length).toFixed(1)}`);
  }
  console.log(`\nport_error ${sizes[best(summed(campaigns, sizes.length))]}`);
}

const [hop, ...programs] = process.argv.slice(2);
if (hop !== undefined) measure(hop, programs);
const learnt = read();
for (const plant of new Set(learnt.campaigns.map((campaign) => campaign.plant)))
  tables({ ...learnt, campaigns: learnt.campaigns.filter((campaign) => campaign.plant === plant) }, plant);
