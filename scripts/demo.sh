#!/bin/sh
# From random genotypes to an iCub that obeys, one run of each condition: scripts/demo.sh FOLDER SEED
set -eu

folder=${1:?usage: scripts/demo.sh FOLDER SEED}
seed=${2:?usage: scripts/demo.sh FOLDER SEED}
runs=$folder/runs

# Found out before anything is evolved; the figures need no drawing of the robot.
films=yes
python -m mujoco_port.doctor.drawing || films=

mkdir -p "$folder"
printf 'seeds = "%d"\nconditions = ["with-indicate", "with-ignore"]\n' "$seed" > "$folder/demo.toml"
wordarm experiment "$folder/demo.toml" --output "$folder/runs"
for condition in with-indicate with-ignore; do
    wordarm evaluate "$runs/$condition/seed-$(printf %04d "$seed")" --output "$folder/$condition"
done

# Condition and instruction; MOVE Blue is one that no network ever heard.
while read -r condition instruction; do
    [ -z "$films" ] ||
        wordarm port "$runs/$condition/seed-$(printf %04d "$seed")" "$instruction" \
            --output "$folder/$(echo "$instruction" | tr ' ' '-').mp4" < /dev/null
done << FILMS
with-indicate indicate red
with-indicate touch red
with-ignore move blue
FILMS

printf '\nDone. Look at:\n'
for file in "$folder"/*/champion-heat-map.png "$folder"/*/fitness.png "$folder"/*.mp4; do
    [ ! -e "$file" ] || printf '  %s\n' "$file"
done
if [ -z "$films" ]; then
    printf '\nThere are no films, since the robot cannot be drawn here; wordarm doctor says what is missing.\n'
    printf 'Once it is there, the same command adds them.\n'
fi
