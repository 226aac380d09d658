# Formats `hop diagnose CAMPAIGN --effects --json` as Markdown; $plant: its name.
def cell: gsub("\\|"; "\\|");
def unit: gsub("\\^2"; "²") | gsub("\\^3"; "³");
def with_unit($unit): if $unit == "" then . else "\(.) \($unit | unit)" end;
def short: if . == 0 then "0" else (. as $v | ($v | fabs | log10 | floor) as $e | ($v * pow(10; 2 - $e) | round) / pow(10; 2 - $e) | tostring) end;
def parameter: .unit as $u | "`\(.name)`: " + (if .typical == null then (if .is_size then "read off the data" else "form of the law" + (if .low == null or .high == null then "" else ", \(.low | short) to \(.high | short | with_unit($u))" end) end)
  else (if .believed == null then "" else "± " end) + (.typical | short | with_unit($u)) end);
"\n## Effects of plant `\($plant)`\n\n| effect | port | sentence and equation | parameters and typical sizes |\n|---|---|---|---|",
(.effects[] | "| `\(.id)` | \(.port) | \(.statement | cell) <code>\(.equation | @html | gsub("\\|"; "&#124;"))</code> | " +
  (if .can_be_seen then ([.parameters[] | parameter] | join("; ")) else "not in this example" end) + " |")
