# Formats one plant of `hop campaign keys PLANT --json` as Markdown.
def name: gsub("_"; " ");
def unit: gsub("\\^2"; "²") | gsub("\\^3"; "³") | gsub(" "; " ");
def cell: gsub("\\|"; "\\|");
def channel: "| `\(.name)` | \(.unit | unit) | \(.meaning | cell) |";
def key: "| `\(.key)` | \(.unit | unit) | \(.default) | \(.meaning | cell)\(if .used then "" else " *(not used so far)*" end) |";
. as $plant |
"\n## Plant `\(.plant)`\n\n\(.meaning[:1] | ascii_upcase)\(.meaning[1:]). Usual kind of trial: `\(.usual_kind)`.\n",
"### Channels of \(.plant | name)\n\n| channel | unit | meaning |\n|---|---|---|",
(.channels[] | channel),
(.keys | map(select(.of_this_plant)) | group_by(.table) | sort_by(.[0].table | [. == "spread", . == "sensors", . != "", .]) | .[] |
  "\n### \($plant.plant | name): \(if .[0].table == "" then "top of nominal.toml" else "[\(.[0].table)]" end)\n\n| key | unit | default | meaning |\n|---|---|---|---|",
  (.[] | key))
