package user

import fc.runtime.Context
import meter.Band
import meter.Client
import meter.CloseSwitchRequest
import meter.CloseSwitchResponse
import meter.ReadPowerRequest
import meter.ReadPowerResponse
import meter.Robot
import meter.SetTariffRequest
import meter.SetTariffResponse
import meter.WatchLoadRequest
import meter.WatchLoadResponse

/** A complete robot and an app. Both must follow the spec. */
class Mine : Robot {
    override suspend fun readPower(context: Context, request: ReadPowerRequest): ReadPowerResponse =
        ReadPowerResponse {
            watts(1.5)
            phases(listOf())
            closed(true)
        }

    override suspend fun setTariff(context: Context, request: SetTariffRequest): SetTariffResponse =
        if (request.band == Band.DAY) SetTariffResponse {} else throw context.notImplemented()

    override suspend fun closeSwitch(context: Context, request: CloseSwitchRequest): CloseSwitchResponse =
        CloseSwitchResponse { job(7) }

    override suspend fun watchLoad(context: Context, request: WatchLoadRequest): WatchLoadResponse = WatchLoadResponse {}
}

suspend fun use(client: Client): Double {
    val request: SetTariffRequest = SetTariffRequest { price(3L).note("x") }
    client.setTariff(request)
    client.closeSwitchFollowed(CloseSwitchRequest {}).close()
    return client.readPower().watts
}
