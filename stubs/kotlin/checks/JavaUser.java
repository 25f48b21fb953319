package user;

import meter.Band;
import meter.Client;
import meter.SetTariffRequest;

/** An app in Java. */
final class JavaUser {
    private JavaUser() {}

    static double use(Client client) {
        client.setTariffAsync(SetTariffRequest.builder().band(Band.DAY).price(3L).note("x").build()).join();
        return client.readPowerAsync().join().getWatts();
    }
}
