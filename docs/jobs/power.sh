#!/bin/bash
# The power of a study on a Slurm cluster: palpa study power, each task of the array a share of the studies (docs/study.md).
#     JOB=$(sbatch --parsable power.sh)
#     sbatch --dependency=afterok:$JOB --wrap "palpa study power protocol.json --participants 6,12,20 --runs 500 -o power --merge"
#SBATCH --job-name=palpa-power
#SBATCH --array=1-20
#SBATCH --cpus-per-task=1
#SBATCH --mem=1G
#SBATCH --time=01:00:00
palpa study power protocol.json --participants 6,12,20 --runs 500 -o power
