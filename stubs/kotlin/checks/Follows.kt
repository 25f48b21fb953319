package user

import fc.runtime.Context
import fc.runtime.Effect
import meter.Client
import meter.CountPulsesRequest
import meter.CountPulsesResponse
import meter.Operations
import meter.PartialRobot
import meter.ReadPowerRequest
import meter.ReadPowerResponse

/** A partial robot. An addition to the spec is not an error here. */
class Partly : PartialRobot {
    override suspend fun readPower(context: Context, request: ReadPowerRequest): ReadPowerResponse =
        ReadPowerResponse { kilo(1.5).shut(true) }
}

/** An app that uses the addition to the spec. */
suspend fun count(client: Client): CountPulsesResponse {
    check(Operations.countPulses.effect == Effect.READ)
    return client.countPulses(CountPulsesRequest {})
}
