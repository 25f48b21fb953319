package user;

import fc.runtime.ClientConfig;
import javax.net.ssl.SSLContext;
import meter.Band;
import meter.Client;
import meter.SetTariffRequest;

/** An app in Java. */
final class JavaUser {
    private JavaUser() {}

    static ClientConfig secured(SSLContext context) {
        return new ClientConfig().tls(context, engine -> engine.setEnabledProtocols(new String[] {"TLSv1.3"}))
                .onCall(call -> System.out.println(call.getOperation() + " " + call.getResult() + " " + call.getNanoseconds()));
    }

    static double use(Client client) {
        client.setTariffAsync(SetTariffRequest.builder().band(Band.DAY).price(3L).note("x").build()).join();
        return client.readPowerAsync().join().getWatts();
    }
}
