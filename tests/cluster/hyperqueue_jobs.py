"""Runs a job list, one command a line, by HyperQueue on this machine, and a last command when all are done.

    hyperqueue_jobs.py JOBS LAST
"""

import sys

from hyperqueue import Job, LocalCluster
from hyperqueue.cluster import WorkerConfig

jobs, last = sys.argv[1:]
with LocalCluster() as cluster:
    cluster.start_worker(WorkerConfig(cores=2))
    job = Job()
    tasks = [job.program(["bash", "-c", line.strip()]) for line in open(jobs)]
    job.program(["bash", "-c", last], deps=tasks)
    client = cluster.client()
    client.wait_for_jobs([client.submit(job)])
