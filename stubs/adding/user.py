"""An app and a robot that use what `noise.yaml` adds."""

from __future__ import annotations

import fc
import fc_runtime as rt


class Ear(fc.PartialRobot):
    async def measure_noise(self, context: rt.Context, request: fc.MeasureNoiseRequest) -> fc.MeasureNoiseResponse:
        band = fc.NoiseBand(hertz=1000, level=float(request.seconds))
        return fc.MeasureNoiseResponse(bands=[band])


async def first_level(client: fc.Client) -> float | None:
    answer = await client.measure_noise(fc.MeasureNoiseRequest(seconds=3))
    return answer.bands[0].level


async def heard(client: fc.Client) -> int | None:
    async for report in client.reports():
        if isinstance(report, fc.NoiseChanged):
            return report.loudest.hertz
    return None


async def tell(reporter: fc.Reporter) -> int:
    report = fc.NoiseChanged(loudest=fc.NoiseBand(hertz=1000))
    return len(await reporter.noise_changed(report))


robot = Ear()
