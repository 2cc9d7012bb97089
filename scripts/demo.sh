#!/bin/sh
# From random genotypes to an iCub that obeys: scripts/demo.sh FOLDER SEED
set -eu

folder=${1:?usage: scripts/demo.sh FOLDER SEED}
seed=${2:?usage: scripts/demo.sh FOLDER SEED}
run=$folder/with-indicate-seed-$seed

wordarm evolve --condition with-indicate --seed "$seed" --output "$run"
wordarm evaluate "$run" --output "$folder"
for instruction in "indicate green" "touch red" "move blue"; do
    wordarm port "$run" "$instruction" --output "$folder/$(echo "$instruction" | tr ' ' '-').mp4"
done

printf '\nDone. Look at:\n'
for file in "$folder"/*.png "$folder"/*.mp4; do
    printf '  %s\n' "$file"
done
