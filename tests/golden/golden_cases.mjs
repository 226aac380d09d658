// Campaigns whose answers are kept: plant, what is hidden, number, first seed, number of trials. There are
// few trials each, so that all of them take minutes. A hopper takes ten times as long as another plant.
const each = (plant, kind, campaigns, seed, trials) =>
  Array.from({ length: campaigns }, (_, i) => ({ name: `${plant}-${kind}-${seed + i}`, plant, kind, seed: seed + i, trials }));

const of_each_kind = (plant, seed) => [
  ...each(plant, 'null', 3, seed, 7),
  ...each(plant, 'single', 6, seed + 20, 7),
  ...each(plant, 'several', 4, seed + 40, 7),
  ...each(plant, 'unknown', 3, seed + 60, 7),
  ...each(plant, 'indistinguishable', 2, seed + 80, 7),
];
const hoppers = [
  ...each('hopper', 'null', 2, 7400, 4),
  ...each('hopper', 'single', 3, 7420, 4),
  ...each('hopper', 'several', 2, 7440, 4),
  ...each('hopper', 'unknown', 1, 7460, 4),
];
const small = [of_each_kind('rotary_axis', 7100), of_each_kind('falling_body', 7200), of_each_kind('intruder', 7300)];

// Plants and kinds are mixed, so that a run that is stopped early has covered all of them.
const stride = 7;
const order = small[0].map((_, i) => (i * stride) % small[0].length);
export const cases = [...order.flatMap(i => small.map(list => list[i])), ...hoppers];
