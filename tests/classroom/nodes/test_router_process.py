from __future__ import annotations

import asyncio
import subprocess
import sys

from studio.classroom.nodes.pool import Pool
from studio.classroom.nodes.router_process import CODEC, AskWell, OpenRouter, RouterOpen, Well
from studio.ros.wire.certificates import new_secret
from studio.ros.wire.endpoints import ProbeResult, parse_endpoint, probe
from studio.workers import Worker
from tests.support.wire import free_endpoint, wait_until

POOL = Pool(new_secret(), (41,))
MODULE = "studio.classroom.nodes.router_process"


def request(*endpoints: str) -> OpenRouter:
    return OpenRouter(endpoints, POOL.router, ((POOL.name_of(41), (41,)),))


def test_it_takes_the_first_endpoint_that_is_free():
    async def work() -> None:
        one, other = Worker("nodes", MODULE, CODEC), Worker("nodes", MODULE, CODEC)
        first, second = free_endpoint("tls"), free_endpoint("tls")
        try:
            assert await one.ask(request(first), RouterOpen, 20) == RouterOpen(first)
            assert await other.ask(request(first, second), RouterOpen, 20) == RouterOpen(second)
            assert await one.ask(AskWell(), Well, 20) == Well()
            refused = await other.ask(request(first), RouterOpen, 20)
            assert refused.reason.startswith(f"No router was started at {first} (another program")
        finally:
            await asyncio.gather(one.close(), other.close())

    asyncio.run(work())


def test_it_ends_when_the_studio_is_gone():
    endpoint = parse_endpoint(free_endpoint("tls"))
    process = subprocess.Popen(
        [sys.executable, "-m", MODULE], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    try:
        assert process.stdin is not None
        process.stdin.write(CODEC.pack(request(endpoint.text)))
        process.stdin.flush()
        wait_until("it listens", lambda: probe(endpoint) is not ProbeResult.NOBODY)
        process.stdin.close()
        assert process.wait(60) == 0
        assert probe(endpoint) is ProbeResult.NOBODY
    finally:
        process.kill()
        process.wait()
        assert process.stdout is not None
        process.stdout.close()
