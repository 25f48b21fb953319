package user

import meter.Band
import meter.OperatorId
import meter.SetTariffRequest
import meter.TariffId

public val operator: OperatorId = OperatorId("anna")

/** A request with the id of a tariff. */
public fun request(): SetTariffRequest = SetTariffRequest {
    band(Band.DAY)
    price(3)
    note("x")
    tariff(TariffId(5))
}
