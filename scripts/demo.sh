#!/bin/sh
# From random genotypes to an iCub that obeys: scripts/demo.sh FOLDER SEED
set -eu

folder=${1:?usage: scripts/demo.sh FOLDER SEED}
seed=${2:?usage: scripts/demo.sh FOLDER SEED}
run=$folder/with-indicate-seed-$seed

# Found out before anything is evolved; the figures need no drawing of the robot.
films=yes
python -m mujoco_port.doctor.drawing || films=

wordarm evolve --condition with-indicate --seed "$seed" --output "$run"
wordarm evaluate "$run" --output "$folder"
for instruction in "indicate green" "touch red" "move blue"; do
    [ -z "$films" ] ||
        wordarm port "$run" "$instruction" --output "$folder/$(echo "$instruction" | tr ' ' '-').mp4"
done

printf '\nDone. Look at:\n'
for file in "$folder"/*.png "$folder"/*.mp4; do
    [ ! -e "$file" ] || printf '  %s\n' "$file"
done
if [ -z "$films" ]; then
    printf '\nThere are no films, since the robot cannot be drawn here; wordarm doctor says what is missing.\n'
    printf 'Once it is there, the same command adds them.\n'
fi
