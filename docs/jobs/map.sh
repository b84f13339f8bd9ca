#!/bin/bash
# One map on a Slurm cluster: palpa maps generate, each task of the array a share of the lines (docs/generate.md).
#     JOB=$(sbatch --parsable map.sh)
#     sbatch --dependency=afterok:$JOB --wrap "palpa maps generate phantom.json -o phantom.map --merge"
#SBATCH --job-name=palpa-map
#SBATCH --array=1-8
#SBATCH --cpus-per-task=1
#SBATCH --mem=1G
#SBATCH --time=00:30:00
palpa maps generate phantom.json -o phantom.map
