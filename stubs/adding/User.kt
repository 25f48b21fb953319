package user

import fc.Client
import fc.MeasureNoiseRequest
import fc.MeasureNoiseResponse
import fc.NoiseBand
import fc.NoiseChanged
import fc.PartialRobot
import fc.Reporter
import fc.runtime.Audience
import fc.runtime.Context
import kotlinx.coroutines.flow.filterIsInstance
import kotlinx.coroutines.flow.first
import kotlinx.coroutines.flow.map

/** An app and a robot that use what `noise.yaml` adds. */
internal class Ear : PartialRobot {
    override suspend fun measureNoise(context: Context, request: MeasureNoiseRequest): MeasureNoiseResponse {
        val band: NoiseBand = NoiseBand { hertz(1000).level(request.seconds.toDouble()) }
        return MeasureNoiseResponse { bands(listOf(band)) }
    }
}

internal suspend fun firstLevel(client: Client): Double? = client.measureNoise(MeasureNoiseRequest { seconds(3) }).bands[0].level

internal suspend fun heard(client: Client): Long = client.reports().use { reports ->
    reports.asFlow().map { it.message }.filterIsInstance<NoiseChanged>().first().loudest.hertz
}

internal suspend fun tell(reporter: Reporter): Int =
    reporter.noiseChanged(Audience.ALL, NoiseChanged { loudest(NoiseBand { hertz(1000) }) }).size
